// spline.h: Hermite splines through the values of an interpolator (ISO/IEC 19775-1 19.2.4). Pure
// functions; they compute in double. [any thread]
#pragma once

#include <cstddef>
#include <span>

#include "behaviour/wide.h"

namespace xvrml {

// A spline through values at keys in increasing order.
template <class T> struct Spline {
  std::span<const float> keys;
  std::span<const T> values; // as many as keys, at least one
  // Velocities at all keys, at the first and the last, or none. Any other number counts as none.
  std::span<const T> velocities;
  bool closed = false;    // the ends have one velocity, if they have one value
  bool normalize = false; // velocities get the length of the polygon of the values

  // Returns the value between the keys `left` and `left` + 1, at parameter t in [0,1].
  T at(size_t left, double t) const {
    const double t2 = t * t, t3 = t2 * t;
    Wide<T> sum;
    sum.add(Wide<T>(values[left]), 2 * t3 - 3 * t2 + 1);
    sum.add(Wide<T>(values[left + 1]), 3 * t2 - 2 * t3);
    sum.add(velocity(left), (t3 - 2 * t2 + t) * factor(left, true));
    sum.add(velocity(left + 1), (t3 - t2) * factor(left + 1, false));
    return sum.narrow();
  }

  // Returns the velocity at a key: T of 19.2.4.
  Wide<T> velocity(size_t i) const {
    const size_t last = keys.size() - 1;
    Wide<T> result;
    if (velocities.size() == keys.size())
      result = Wide<T>(velocities[i]);
    else if (velocities.size() == 2 && (i == 0 || i == last))
      result = Wide<T>(velocities[i == 0 ? 0 : 1]);
    else if (i > 0 && i < last)
      return result.add(Wide<T>(values[i + 1]), 0.5).add(Wide<T>(values[i - 1]), -0.5);
    else
      return isLoop() ? result.add(Wide<T>(values[1]), 0.5).add(Wide<T>(values[last - 1]), -0.5)
                      : result;
    const double length = result.length();
    if (!normalize || !(length > 0)) return result;
    return Wide<T>().add(result, pathLength() / length);
  }

 private:
  // Returns whether the path is closed: velocities that are given for its ends take precedence.
  bool isLoop() const {
    return closed && velocities.size() != 2 && values.size() > 2 && values.front() == values.back();
  }

  double pathLength() const {
    double sum = 0;
    for (size_t i = 0; i + 1 < values.size(); ++i)
      sum += Wide<T>(values[i]).add(Wide<T>(values[i + 1]), -1).length();
    return sum;
  }

  // Returns the factor of a velocity that evens out intervals of different lengths: F+ of 19.2.4
  // for the interval that begins at the key, F- for the one that ends there.
  double factor(size_t i, bool begins) const {
    const size_t last = keys.size() - 1;
    const bool isEnd = i == 0 || i == last;
    if (isEnd && !isLoop()) return 1;
    const double before =
        isEnd ? double(keys[last]) - keys[last - 1] : double(keys[i]) - keys[i - 1];
    const double after = isEnd ? double(keys[1]) - keys[0] : double(keys[i + 1]) - keys[i];
    const double both = before + after;
    return both > 0 ? 2 * (begins ? before : after) / both : 1;
  }
};

} // namespace xvrml
