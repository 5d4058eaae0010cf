// byte_reader.h: Reads numbers and bytes of a file one after the other. [any thread]
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace picture {

// A file that is damaged or not complete. The text says where: "it is damaged at byte 9: ...".
struct BrokenFile : std::runtime_error {
  using runtime_error::runtime_error;
};

class ByteReader {
 public:
  // at: the place of the first byte in the file, for messages
  explicit ByteReader(std::string_view bytes, uint64_t at = 0) : left_(bytes), at_(at) {}

  // Returns the next bytes. Throws BrokenFile if there are fewer.
  std::string_view take(uint64_t size) {
    if (size > left_.size())
      throw BrokenFile(
          fmt::format("it is truncated or damaged: from byte {} on, {} of {} bytes are there", at_,
                      left_.size(), size));
    const std::string_view taken = left_.substr(0, size_t(size));
    left_.remove_prefix(size_t(size));
    at_ += size;
    return taken;
  }

  // Returns the next number, which is little-endian.
  template <class T> T number() {
    static_assert(std::endian::native == std::endian::little);
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

  // Returns the bytes up to the next 0, which is skipped. Throws BrokenFile if there is none.
  std::string_view textBeforeZero() {
    const std::string_view text = take(std::min(left_.find('\0'), left_.size()));
    take(1);
    return text;
  }

  bool empty() const { return left_.empty(); }
  size_t left() const { return left_.size(); }
  uint64_t at() const { return at_; }

 private:
  std::string_view left_;
  uint64_t at_;
};

} // namespace picture
