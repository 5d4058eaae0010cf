#include "backend/cluster/messages/text.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "backend/cluster/messages/limits.h"

namespace openrt::cluster {
namespace {

// Returns the length of the UTF-8 character at the beginning (RFC 3629); 0 if it is invalid.
size_t characterAt(std::string_view text) {
  const auto byte = [&](size_t i) {
    return i < text.size() ? static_cast<uint8_t>(text[i]) : uint8_t(0);
  };
  const uint8_t first = byte(0), second = byte(1);
  const size_t length = first < 0x80   ? 1
                        : first < 0xc2 ? 0
                        : first < 0xe0 ? 2
                        : first < 0xf0 ? 3
                        : first < 0xf5 ? 4
                                       : 0;
  for (size_t i = 1; i < length; i++)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Overlong forms, surrogate halves, beyond Unicode.
  const bool outside = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                       (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return outside ? 0 : length;
}

} // namespace

void clean(std::span<char> text) {
  for (size_t i = 0; i < text.size();) {
    const size_t length = characterAt({text.data() + i, text.size() - i});
    const auto first = static_cast<uint8_t>(text[i]),
               second = length == 2 ? static_cast<uint8_t>(text[i + 1]) : uint8_t(0);
    if (first < ' ' || first == 0x7f || (first == 0xc2 && length == 2 && second < 0xa0))
      std::fill_n(&text[i], length, ' ');
    else if (length == 0)
      text[i] = '?';
    i += std::max<size_t>(length, 1);
  }
}

void demand(bool good, const char* why) {
  if (!good) throw BadMessage{why};
}

Text::Text(std::string text) : std::string(std::move(text)) {
  if (size() > limits::textBytes) resize(limits::textBytes);
}

Text::Text(const char* received, size_t size) {
  demand(size <= limits::textBytes, "a text is too long");
  assign(received, size);
  clean(*this);
}

} // namespace openrt::cluster
