// search_frame.h: brings a ray given in double to the frame in which a CandidateScene finds
// candidates in single precision, and tells when that would lose some. Pure functions. [any thread]
#pragma once

#include "backend/local/accel/candidates.h"
#include "backend/local/double/crossings.h"

namespace openrt {

// A frame in which a body lies within [-1, 1]^3. It computes in long double, which has 64 bits of
// mantissa on x86, so that rays may start 2^30 sizes of the body away.
class SearchFrame {
 public:
  SearchFrame() = default;
  // The body lies within center +- 1 / unit, in a space that the matrix maps to the world.
  SearchFrame(const Matrix4d& toWorld, const Vec3d& center, double unit);

  struct Way {
    Search search = Search::none;
    FrameRay ray;      // begins at `start`; its direction has unit length
    double start = 0;  // in the world's t
    double length = 1; // the length of `ray` for each unit of the world's t
    // Converts t of the ray given, beyond which nothing is of interest, to t of `ray`, and not too
    // low.
    double fromRay(double t) const {
      return (t - start + 0x1p-50 * (std::fabs(t) + std::fabs(start))) * length;
    }
  };
  // far: as the ray's, or nearer.
  Way wayOf(const DoubleRay& ray, double far) const;

  // A point in the frame; no component is off by more than the error.
  struct Spot {
    Vec3d point;
    double error;
  };
  Spot spotOf(const Vec3d& point) const;
  // Returns how much longer lengths of the world can be in the frame.
  double stretch() const { return stretch_; }

 private:
  using Long = Vec3<long double>;
  Rows<long double> inverse_; // from the world, after the subtraction of center_
  Long center_;               // in the world
  // Bounds of the errors, as sums over a row: of inverse_, and of center_.
  long double size_ = 0, inverseError_ = 0, centerError_ = 0;
  double stretch_ = 1;
};

} // namespace openrt
