// analytic_error.cpp: bounds the errors of crossings with analytic surfaces (crossings.h). The
// equation is evaluated with Bounded numbers on both sides of a crossing. Where its signs are
// certain and differ, a true crossing lies between (intermediate value theorem).
#include "backend/local/double/bounded.h"
#include "backend/local/double/crossings.h"

namespace openrt {
namespace {

using Vec = Vec3<Bounded>;

Bounded quadricAt(const std::vector<double>& f, const Vec& p) {
  return p.x * (f[0] * p.x + f[3] * p.y + f[5] * p.z + f[6]) +
         p.y * (f[1] * p.y + f[4] * p.z + f[7]) + p.z * (f[2] * p.z + f[8]) + f[9];
}

// n: as AnalyticSurface describes the numbers of an asphere.
Bounded asphereAt(const std::vector<double>& n, const Vec& p) {
  const Bounded u = p.x * p.x + p.y * p.y, under = 1 - (1 + Bounded(n[1])) * n[0] * n[0] * u;
  if (under.sign() <= 0) return {0, HUGE_VAL};
  Bounded sum;
  for (size_t i = n.size(); i-- > 4;) sum = sum * u + n[i];
  return p.z - n[0] * u / (1 + sqrt(under)) - sum * u * u;
}

class Equation {
 public:
  Equation(const DoubleRay& ray, const Matrix4d& world, const AnalyticSurface& surface)
      : quadric_(surface.kind() == edit::Primitive::Quadric), numbers_(surface.numbers()),
        direction_(ray.direction) {
    const Vec x(world.column(0)), y(world.column(1)), z(world.column(2));
    rows_[0] = cross(y, z);
    rows_[1] = cross(z, x);
    rows_[2] = cross(x, y);
    determinant_ = dot(x, rows_[0]);
    from_ = Vec(ray.origin) - Vec(world.translation());
  }
  // Returns the sign of the equation at a point of the ray; 0 if it is not certain.
  int signAt(double t) const {
    const Vec p = from_ + direction_ * Bounded(t);
    const Vec local{dot(rows_[0], p) / determinant_, dot(rows_[1], p) / determinant_,
                    dot(rows_[2], p) / determinant_};
    return (quadric_ ? quadricAt(numbers_, local) : asphereAt(numbers_, local)).sign();
  }

 private:
  bool quadric_;
  std::vector<double> numbers_;
  Vec rows_[3], from_, direction_; // rows_: of the adjugate matrix
  Bounded determinant_;
};

} // namespace

double analyticError(const DoubleRay& ray, const Matrix4d& world, const AnalyticSurface& surface,
                     double t) {
  const Equation equation(ray, world, surface);
  const double reach =
      std::fabs(t) + largest(abs(ray.origin - world.translation())) / largest(abs(ray.direction));
  for (double error = 0x1p-52 * std::fabs(t) + 0x1p-62 * reach; error <= 0x1p-10 * reach;
       error *= 4) {
    const int before = equation.signAt(t - error);
    if (before != 0 && equation.signAt(t + error) == -before) return error * Bounded::inflated;
  }
  return HUGE_VAL;
}

} // namespace openrt
