// number.h: parses VRML97 numbers (Annex A.4), correctly rounded. A path with few branches handles
// the short decimals that fill big arrays; fast_float handles the rest. Used in the value parser's
// loops. [any thread]
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <fast_float/fast_float.h>

namespace xvrml {

enum class NumberError : uint8_t { none, notANumber, outOfRange };

namespace number_detail {

inline constexpr double powersOfTen[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8};
inline constexpr uint32_t integerPowersOfTen[] = {1,      10,      100,      1000,     10000,
                                                  100000, 1000000, 10000000, 100000000};

// The value and the number of up to eight digits at p. Eight bytes are read. The digits are
// converted together as in Lemire, "Number parsing at a gigabyte per second" (2021); a bit scan
// instead of a loop finds their number.
struct Digits {
  uint32_t value;
  int count;
};
inline Digits readDigits(const char* p) {
  static_assert(std::endian::native == std::endian::little);
  uint64_t bytes = 0;
  std::memcpy(&bytes, p, 8);
  bytes ^= 0x3030303030303030; // digits become 0..9
  // A byte above 9 gets its top bit set: it has a high nibble, or adding 0x76 carries into bit 7.
  const uint64_t other = ((bytes & 0x7f7f7f7f7f7f7f7f) + 0x7676767676767676) | bytes;
  const uint64_t marks = other & 0x8080808080808080;
  const int count = marks ? std::countr_zero(marks) >> 3 : 8;
  if (count == 0) return {0, 0};
  bytes <<= 64 - 8 * count; // the missing digits become leading zeros
  bytes = bytes * 10 + (bytes >> 8);
  constexpr uint64_t mask = 0x000000ff000000ff, mul1 = 0x000f424000000064,
                     mul2 = 0x0000271000000001;
  return {static_cast<uint32_t>((((bytes & mask) * mul1) + (((bytes >> 16) & mask) * mul2)) >> 32),
          count};
}

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }

template <class T> NumberError readSlow(const char*& p, const char* end, T& out) {
  const char* start = p;
  if (start < end && *start == '+') ++start;
  const char* first = start < end && *start == '-' && start == p ? start + 1 : start;
  if (first >= end || !(isDigit(*first) || *first == '.'))
    return NumberError::notANumber; // rejects nan, inf, +-1
  const auto result = fast_float::from_chars(start, end, out);
  if (result.ptr == start) return NumberError::notANumber;
  p = result.ptr;
  return std::isfinite(out) ? NumberError::none : NumberError::outOfRange;
}

} // namespace number_detail

// Reads the longest number at p and moves p behind it. On an error, p is unchanged or, for
// outOfRange, behind the number. Underflow gives the nearest representable number.
inline NumberError readNumber(const char*& p, const char* end, float& out) {
  using namespace number_detail;
  if (end - p > 24) {
    const char* q = p;
    const bool negative = *q == '-';
    q += negative;
    const Digits whole = readDigits(q);
    q += whole.count;
    uint64_t mantissa = whole.value;
    int decimals = 0;
    if (*q == '.') {
      const Digits fraction = readDigits(++q);
      decimals = fraction.count;
      mantissa = mantissa * integerPowersOfTen[decimals] + fraction.value;
      q += decimals;
    }
    // With at most 15 digits and nothing more to come, mantissa and power are exact doubles, so
    // that their quotient is correctly rounded (Clinger 1990). Rounding it again to float is
    // correct unless it lies exactly half way between two floats.
    const int digits = whole.count + decimals;
    if (digits > 0 && digits <= 15 && !isDigit(*q) && *q != 'e' && *q != 'E' && *q != '.') {
      const double value = static_cast<double>(mantissa) / powersOfTen[decimals];
      if ((std::bit_cast<uint64_t>(value) & 0x1fffffff) != 0x10000000) {
        out = static_cast<float>(negative ? -value : value);
        p = q;
        return NumberError::none;
      }
    }
  }
  return readSlow(p, end, out);
}

inline NumberError readNumber(const char*& p, const char* end, double& out) {
  return number_detail::readSlow(p, end, out);
}

// Reads decimal or 0x hexadecimal digits. Eight hexadecimal digits are the bits (0xFFFFFFFF is -1).
inline NumberError readNumber(const char*& p, const char* end, int32_t& out) {
  using namespace number_detail;
  const char* q = p;
  const bool negative = q < end && *q == '-';
  if (q < end && (*q == '-' || *q == '+')) ++q;
  if (end - q > 10) {
    const Digits digits = readDigits(q);
    if (digits.count > 0 && digits.count < 8 && (q[1] | 0x20) != 'x') {
      const int32_t value = static_cast<int32_t>(digits.value);
      out = negative ? -value : value;
      p = q + digits.count;
      return NumberError::none;
    }
  }
  uint64_t value = 0;
  constexpr uint64_t limit = 1ull << 33; // larger than every range, far from overflow
  const bool hexadecimal = end - q > 2 && q[0] == '0' && (q[1] | 0x20) == 'x';
  const char* start = hexadecimal ? q += 2 : q;
  for (; q < end; ++q) {
    unsigned digit = static_cast<unsigned char>(*q) - '0';
    if (hexadecimal && digit > 9) {
      digit = (static_cast<unsigned char>(*q) | 0x20) - 'a';
      digit = digit < 6 ? digit + 10 : 255;
    }
    if (digit >= (hexadecimal ? 16u : 10u)) break;
    if (value < limit) value = value * (hexadecimal ? 16 : 10) + digit;
  }
  if (q == start) return NumberError::notANumber;
  p = q;
  const uint64_t maximum = hexadecimal ? 0xffffffffu : negative ? 0x80000000u : 0x7fffffffu;
  if (value > maximum) return NumberError::outOfRange;
  const uint32_t bits = static_cast<uint32_t>(value);
  out = static_cast<int32_t>(negative ? 0u - bits : bits);
  return NumberError::none;
}

} // namespace xvrml
