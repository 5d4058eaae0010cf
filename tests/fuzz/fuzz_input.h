// fuzz_input.h: reads values from the fuzzer's bytes: small numbers that often repeat, so that
// messages fit together. Once the bytes are used up it returns zeros.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

namespace openrt {

class FuzzInput {
 public:
  explicit FuzzInput(std::span<const std::byte> bytes) : left_(bytes) {}
  bool empty() const { return left_.empty(); }
  uint8_t byte() {
    if (left_.empty()) return 0;
    const auto first = uint8_t(left_[0]);
    left_ = left_.subspan(1);
    return first;
  }
  size_t below(size_t n) { return byte() % n; }
  bool flip() { return byte() & 1; }
  template <class T> T raw() {
    T value{};
    const size_t size = std::min(sizeof value, left_.size());
    if (size > 0) std::memcpy(&value, left_.data(), size);
    left_ = left_.subspan(size);
    return value;
  }
  // Returns a number, usually a small one.
  uint64_t number() {
    const uint8_t b = byte();
    return b < 250 ? b % 25 : raw<uint64_t>();
  }
  double real() {
    constexpr double odd[] = {0,
                              1,
                              -1,
                              0.5,
                              1e-320,
                              1e308,
                              -1e308,
                              std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()};
    const size_t i = below(std::size(odd) + 2);
    return i < std::size(odd) ? odd[i] : raw<double>();
  }
  std::vector<std::byte> bytes(size_t most) {
    const size_t size = std::min<size_t>({byte() * size_t(4), most, left_.size()});
    const auto part = left_.first(size);
    left_ = left_.subspan(size);
    return {part.begin(), part.end()};
  }

 private:
  std::span<const std::byte> left_;
};

} // namespace openrt
