// foreign.h: pictures whose formats are decoded by another process (decode/decoder.h). [any thread]
#pragma once

#include <optional>
#include <span>

#include "decode/protocol.h"
#include "image/image.h"
#include "xvrml/radiance.h"

namespace xvrml {

struct ForeignFormat {
  const char *name, *mediaType;
  decoding::Format format;
};

// Recognises WebP, BMP and TGA by their first bytes; null if it is none of them.
const ForeignFormat* foreignFormat(std::span<const uint8_t> bytes);

// Decode a picture; throw std::runtime_error.
Image decodeForeign(const ForeignFormat& format, std::span<const uint8_t> bytes,
                    const ImageRoom& room);
RadianceImage decodeExr(std::span<const uint8_t> bytes, const ImageRoom& room);

} // namespace xvrml
