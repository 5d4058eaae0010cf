// xvrml_image.cpp: decodes arbitrary bytes as a picture. The first byte chooses the format, so that
// the fuzzer need not find its magic number. libFuzzer calls this on one thread.
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "image/cube_faces.h"
#include "image/decoders.h"
#include "image/foreign.h"
#include "image/volume.h"
#include "xvrml/radiance.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  if (size == 0) return 0;
  static const char* const magic[] = {
      "", "\x89PNG\r\n\x1a\n", "\xff\xd8\xff", "GIF89a", "#?RGBE\n", "PF\n", "DDS ", "NRRD0004\n"};
  const bool volume = data[0] & 8; // NRRD, or DDS as a volume
  const char* start = magic[!volume ? data[0] % 7 : data[0] & 1 ? 6 : 7];
  std::vector<uint8_t> bytes(start, start + std::strlen(start));
  bytes.insert(bytes.end(), data + 1, data + size);
  // Default limits. run-fuzz.sh bounds the memory, so that a decoder that allocates what a header
  // states is found.
  if (size > 16384) return 0; // limits the unpacked size to 200 MB
  const std::string_view type = xvrml::mediaTypeOf(bytes);
  if (type == "image/x-exr" || xvrml::foreignFormat(bytes)) return 0; // fuzz_xvrml_decoder
  const xvrml::Limits limits{};
  if (volume) {
    const xvrml::Volume v = xvrml::decodeVolume(bytes, xvrml::ImageRoom{limits});
    if (v.pixels.size() !=
        size_t(v.width) * size_t(v.height) * size_t(v.depth) * size_t(v.components))
      __builtin_trap();
    return 0;
  }
  if (xvrml::looksLikeDds(bytes)) {
    const xvrml::CubePictures cube = xvrml::decodeDds(bytes, xvrml::ImageRoom{limits});
    if (cube.images.size() + cube.radiance.size() != xvrml::cubeFaces) __builtin_trap();
    return 0;
  }
  if (xvrml::looksLikeRadiance(bytes.data(), bytes.size())) {
    xvrml::Limits small;
    small.imagePixels = 1 << 20;
    const xvrml::RadianceImage sky = xvrml::decodeRadiance(bytes.data(), bytes.size(), small);
    if (sky.rgb.size() != size_t(sky.width) * size_t(sky.height) * 3) __builtin_trap();
    return 0;
  }
  const xvrml::Image image = xvrml::decodeImage(bytes.data(), bytes.size(), limits);
  if (image.pixels.size() != size_t(image.width) * size_t(image.height) * size_t(image.components))
    __builtin_trap();
  return 0;
} catch (const std::runtime_error&) { return 0; }
