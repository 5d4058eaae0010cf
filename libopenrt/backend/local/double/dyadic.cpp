// dyadic.cpp: arithmetic of Dyadic numbers, as one does it by hand, with digits of 32 bits.
#include "backend/local/double/dyadic.h"

#include <cmath>

namespace openrt {

Dyadic::Dyadic(double value) : negative_(value < 0) {
  if (value == 0) return;
  int exponent = 0;
  const auto digits = uint64_t(std::ldexp(std::frexp(std::fabs(value), &exponent), 53));
  exponent -= 53;
  first_ = exponent >= 0 ? exponent / 32 : -((31 - exponent) / 32);
  const int shift = exponent - 32 * first_; // 0 to 31
  const uint64_t low = digits << shift;
  limbs_.reset(3);
  limbs_[0] = uint32_t(low);
  limbs_[1] = uint32_t(low >> 32);
  limbs_[2] = shift == 0 ? 0 : uint32_t(digits >> (64 - shift));
  trim();
}

void Dyadic::trim() {
  size_t first = 0, last = limbs_.size();
  while (last > 0 && limbs_[last - 1] == 0) last--;
  while (first < last && limbs_[first] == 0) first++;
  limbs_.keep(first, last);
  first_ = limbs_.empty() ? 0 : first_ + int(first);
  if (limbs_.empty()) negative_ = false;
}

Dyadic Dyadic::operator-() const {
  Dyadic d = *this;
  d.negative_ = !negative_ && !limbs_.empty();
  return d;
}

// Adds, or subtracts if the signs differ, the limbs of both at their places. A difference that
// turns out negative is complemented.
Dyadic operator+(const Dyadic& a, const Dyadic& b) {
  if (a.limbs_.empty()) return b;
  if (b.limbs_.empty()) return a;
  Dyadic sum;
  sum.negative_ = a.negative_;
  sum.first_ = std::min(a.first_, b.first_);
  const int end = std::max(a.first_ + int(a.limbs_.size()), b.first_ + int(b.limbs_.size())) + 1;
  sum.limbs_.reset(size_t(end - sum.first_));
  std::copy(a.limbs_.begin(), a.limbs_.end(), sum.limbs_.begin() + (a.first_ - sum.first_));
  const int64_t factor = a.negative_ == b.negative_ ? 1 : -1;
  int64_t carry = 0;
  for (size_t i = size_t(b.first_ - sum.first_), k = 0; i < sum.limbs_.size(); i++, k++) {
    carry += int64_t(sum.limbs_[i]) + (k < b.limbs_.size() ? factor * int64_t(b.limbs_[k]) : 0);
    sum.limbs_[i] = uint32_t(carry);
    carry >>= 32;
  }
  if (carry < 0) {
    sum.negative_ = !sum.negative_;
    uint64_t one = 1;
    for (uint32_t& limb : sum.limbs_) {
      one += uint32_t(~limb);
      limb = uint32_t(one);
      one >>= 32;
    }
  }
  sum.trim();
  return sum;
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  Dyadic product;
  if (a.limbs_.empty() || b.limbs_.empty()) return product;
  product.limbs_.reset(a.limbs_.size() + b.limbs_.size());
  for (size_t i = 0; i < a.limbs_.size(); i++) {
    uint64_t carry = 0;
    for (size_t k = 0; k < b.limbs_.size(); k++) {
      carry += uint64_t(a.limbs_[i]) * b.limbs_[k] + product.limbs_[i + k];
      product.limbs_[i + k] = uint32_t(carry);
      carry >>= 32;
    }
    product.limbs_[i + b.limbs_.size()] = uint32_t(carry);
  }
  product.first_ = a.first_ + b.first_;
  product.negative_ = a.negative_ != b.negative_;
  product.trim();
  return product;
}

// The three highest limbs hold at least 65 bits. Their sum is rounded twice, the rest is dropped.
double Dyadic::mantissa(int& exponent) const {
  double m = 0;
  const size_t count = limbs_.size();
  for (size_t i = 0; i < std::min<size_t>(count, 3); i++)
    m += std::ldexp(double(limbs_[count - 1 - i]), -32 * int(i));
  exponent = 32 * (first_ + int(count) - 1);
  return negative_ ? -m : m;
}

Bounded Dyadic::rounded() const {
  if (limbs_.empty()) return {};
  int exponent = 0;
  const double m = mantissa(exponent), value = std::ldexp(m, exponent);
  return {value, 0x1p-51 * std::fabs(value) + Bounded::tiny};
}

Bounded quotient(const Dyadic& a, const Dyadic& b) {
  if (a.limbs_.empty()) return {};
  int above = 0, below = 0;
  const double over = a.mantissa(above), under = b.mantissa(below);
  const double value = std::ldexp(over / under, above - below);
  return {value, 0x1p-49 * std::fabs(value) + Bounded::tiny};
}

} // namespace openrt
