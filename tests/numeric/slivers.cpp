// slivers.cpp: closed boxes and tubes up to a million times longer than wide, in odd directions.
// * No ray from inside leaves.
// * Hit points agree with long double.
// * The same box as a dynamic instance gives the same answers up to rounding.
#include <cstdint>
#include <limits>
#include <random>

#include "numeric/support.h"
#include "openrt/query.h"

namespace numeric {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr double ulp = 0x1p-24; // half an ulp of 1: the rounding error of a float

using Matrix = std::array<double, 16>;

Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec unit(Vec a) { return a * (1 / std::sqrt(dot(a, a))); }

// Random numbers that are the same on every machine.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * engine_() / 4294967296.0;
  }
  double sign() { return engine_() & 1 ? 1 : -1; }
  Vec direction() {
    while (true) {
      const Vec v{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
      if (dot(v, v) > .01 && dot(v, v) < 1) return unit(v);
    }
  }

 private:
  std::mt19937 engine_;
};

// A rotation about a random axis by a random angle, and a translation.
Matrix turned(Random& random, double far) {
  const Vec z = random.direction(), x = unit(cross(z, random.direction())), y = cross(z, x);
  const Vec t = random.direction() * far;
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, t.x, t.y, t.z, 1};
}
Vec apply(const Matrix& m, Vec p) {
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
          m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

constexpr uint32_t boxCorners[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

struct Box {
  Vec half;
  std::vector<float> points() const {
    std::vector<float> p;
    for (int i = 0; i < 8; i++) {
      p.push_back(float(i & 1 ? half.x : -half.x));
      p.push_back(float(i & 2 ? half.y : -half.y));
      p.push_back(float(i & 4 ? half.z : -half.z));
    }
    return p;
  }
};

RTid boxObject(const Box& box) {
  const std::vector<float> points = box.points();
  const RTid object = rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  rtDrawElements(RT_TRIANGLES, 36, boxCorners, 8);
  rtVertexPointer(3, RT_FLOAT, 0, nullptr);
  rtEndObject();
  return object;
}

// Returns how deep a point is inside a box: the smallest distance to a face, in the box's frame.
double depth(const Box& box, Vec p) {
  return std::min(
      {box.half.x - std::fabs(p.x), box.half.y - std::fabs(p.y), box.half.z - std::fabs(p.z)});
}
// Returns where a ray from inside leaves the box. grazing: sine of the angle with the face.
double leaves(const Box& box, Vec from, Vec d, double& grazing) {
  const double o[3] = {from.x, from.y, from.z}, v[3] = {d.x, d.y, d.z},
               h[3] = {box.half.x, box.half.y, box.half.z};
  double end = HUGE_VAL;
  for (int k = 0; k < 3; k++) {
    if (v[k] == 0) continue;
    const double t = ((v[k] > 0 ? h[k] : -h[k]) - o[k]) / v[k];
    if (t < end) {
      end = t;
      grazing = std::fabs(v[k]);
    }
  }
  return end;
}

class Slivers : public Scene {
 protected:
  // A ray in world space from inside a box: in all directions, along its length, or grazing a face
  // at 1 to 1e-7.
  struct Shot {
    RTray ray;
    Vec from, direction; // after rounding, in the frame of the box
    double depth;
  };
  static std::vector<Shot> shots(const Box& box, const Matrix& m, Random& random, size_t count) {
    std::vector<RTray> rays;
    const double h[3] = {box.half.x, box.half.y, box.half.z};
    for (size_t i = 0; i < count; i++) {
      double p[3], q[3];
      for (int k = 0; k < 3; k++) {
        p[k] = .95 * h[k] * random(-1, 1);
        q[k] = 1.2 * h[k] * random(-1, 1);
      }
      Vec to{q[0], q[1], q[2]};
      if (i % 3 == 0) to = Vec{p[0], p[1], p[2]} + random.direction();
      if (i % 3 == 1) { // a face hit at the far end of a long way
        const int face = int(random(0, 3)), along = (face + 1 + int(random(0, 2))) % 3;
        const double sine = std::pow(10, random(-7, 0)), way = h[along] * random(.1, 1.5);
        const double towards = random.sign(), side = random.sign();
        p[along] = -side * h[along] * random(0, .95);
        p[face] = towards * std::max(h[face] - way * sine, -.9 * h[face]);
        Vec d;
        double v[3] = {0, 0, 0};
        v[along] = side;
        v[face] = towards * sine;
        d = {v[0], v[1], v[2]};
        to = Vec{p[0], p[1], p[2]} + d * way;
      }
      const Vec from = apply(m, {p[0], p[1], p[2]}), d = unit(apply(m, to) - from);
      rays.push_back({{float(from.x), float(from.y), float(from.z)},
                      0,
                      {float(d.x), float(d.y), float(d.z)},
                      infinity});
    }
    return judged(box, m, rays);
  }
  // Converts the rays back to the box's frame after they were rounded to float.
  static std::vector<Shot> judged(const Box& box, const Matrix& m, const std::vector<RTray>& rays) {
    std::vector<Shot> out;
    for (const RTray& r : rays) {
      const volatile float* o = r.origin;
      const volatile float* d = r.direction;
      const Vec t{o[0] - m[12], o[1] - m[13], o[2] - m[14]}, v{d[0], d[1], d[2]};
      const auto back = [&](Vec a) {
        return Vec{m[0] * a.x + m[1] * a.y + m[2] * a.z, m[4] * a.x + m[5] * a.y + m[6] * a.z,
                   m[8] * a.x + m[9] * a.y + m[10] * a.z};
      };
      Shot s{r, back(t), back(v), 0};
      s.depth = numeric::depth(box, s.from);
      out.push_back(s);
    }
    return out;
  }
  static std::vector<RThit> cast(const std::vector<Shot>& shots) {
    std::vector<RTray> rays;
    for (const Shot& s : shots) rays.push_back(s.ray);
    std::vector<RThit> hits(rays.size());
    rtCastRays(rays.size(), rays.data(), hits.data());
    return hits;
  }
};

constexpr double ratios[] = {1, 10, 100, 200, 300, 1e3, 4e3, 1e4, 1e5, 1e6};

// Calls f for a box of ratio:1:1 and one of ratio:ratio:1. Each is turned three times: once near
// the origin, twice far from it.
template <class F> void forBoxes(const F& f) {
  uint32_t seed = 1;
  for (const double ratio : ratios)
    for (const bool flat : {false, true})
      for (int turn = 0; turn < 3; turn++) {
        Random random(seed++);
        const Box box{{ratio / 2, flat ? ratio / 2 : .5, .5}};
        const Matrix m = turned(random, turn * ratio);
        f(box, m, random, ratio,
          ::testing::Message() << ratio << (flat ? " flat" : " long") << " turn " << turn);
      }
}

TEST_F(Slivers, NoRayLeavesAClosedBox) {
  constexpr size_t count = 6000;
  forBoxes([&](const Box& box, const Matrix& m, Random& random, double ratio,
               const ::testing::Message& what) {
    for (const bool dynamic : {false, true}) {
      rtPushMatrix();
      rtLoadIdentity();
      rtMultMatrixd(m.data());
      const RTid object = boxObject(box), instance = place(object);
      rtPopMatrix();
      if (dynamic) rtInstanceHint(instance, RT_DYNAMIC);
      rtRender();
      const std::vector<Shot> all = shots(box, m, random, count);
      const std::vector<RThit> hits = cast(all);
      std::vector<RTray> rays;
      for (const Shot& s : all) rays.push_back(s.ray);
      std::vector<uint8_t> occluded(count);
      rtOccludedRays(count, rays.data(), occluded.data());
      size_t inside = 0, left = 0, open = 0;
      for (size_t i = 0; i < count; i++) {
        if (all[i].depth < 40 * ulp * 3 * ratio) continue; // rounding may move this origin outside
        inside++;
        left += !std::isfinite(hits[i].t);
        open += !occluded[i];
      }
      EXPECT_EQ(left, 0u) << what << (dynamic ? " dynamic" : "") << " of " << inside;
      EXPECT_EQ(open, 0u) << what << (dynamic ? " dynamic" : "") << " of " << inside;
      EXPECT_TRUE(inside > count / 2 || ratio > 1e4) << what; // the next test has the longer boxes
      rtDeleteInstance(instance);
      rtDeleteObject(object);
    }
  });
}

// Returns whether a point is inside the closed box whose corners are floats, by more than a
// thousandth of its width.
bool isInside(const Box& box, const Matrix& m, Vec p) {
  const std::vector<float> points = box.points();
  const auto corner = [&](uint32_t i) {
    const Vec c = apply(m, {points[3 * i], points[3 * i + 1], points[3 * i + 2]});
    return Vec{double(float(c.x)), double(float(c.y)), double(float(c.z))};
  };
  const Vec middle{m[12], m[13], m[14]};
  for (int t = 0; t < 12; t++) {
    const Vec a = corner(boxCorners[3 * t]), b = corner(boxCorners[3 * t + 1]),
              c = corner(boxCorners[3 * t + 2]);
    const Vec normal = unit(cross(b - a, c - a));
    const double side = dot(normal, middle - a) > 0 ? 1 : -1;
    if (side * dot(normal, p - a) < 1e-3) return false;
  }
  return true;
}

// A box of 1e6:1:1 is hardly wider than an ulp of its corners. The test uses the closed box that
// the rounded corners form.
TEST_F(Slivers, NoRayLeavesTheBoxOfItsRoundedCorners) {
  constexpr size_t count = 6000;
  uint32_t seed = 100;
  for (const double ratio : {1e4, 1e5, 1e6})
    for (const bool flat : {false, true})
      for (int turn = 0; turn < 3; turn++) {
        Random random(seed++);
        const Box box{{ratio / 2, flat ? ratio / 2 : .5, .5}};
        const Matrix m = turned(random, 0);
        rtPushMatrix();
        rtLoadIdentity();
        rtMultMatrixd(m.data());
        const RTid object = boxObject(box), instance = place(object);
        rtPopMatrix();
        rtRender();
        const std::vector<Shot> all = shots(box, m, random, count);
        const std::vector<RThit> hits = cast(all);
        size_t inside = 0, left = 0;
        for (size_t i = 0; i < count; i++) {
          const float* o = all[i].ray.origin;
          if (!isInside(box, m, {o[0], o[1], o[2]})) continue;
          inside++;
          left += !std::isfinite(hits[i].t);
        }
        EXPECT_EQ(left, 0u) << ratio << (flat ? " flat " : " long ") << turn << ": of " << inside;
        EXPECT_GT(inside, count / 4) << ratio << (flat ? " flat " : " long ") << turn;
        rtDeleteInstance(instance);
        rtDeleteObject(object);
      }
}

// The distance along a ray may differ by the rounding of vertices and rays, divided by the sine of
// the grazing angle.
TEST_F(Slivers, StaticAndDynamicBoxesDifferInTheLastBits) {
  constexpr size_t count = 6000;
  forBoxes([&](const Box& box, const Matrix& m, Random& random, double ratio,
               const ::testing::Message& what) {
    const std::vector<Shot> all = shots(box, m, random, count);
    std::vector<RThit> found[2];
    for (const bool dynamic : {false, true}) {
      rtPushMatrix();
      rtLoadIdentity();
      rtMultMatrixd(m.data());
      const RTid object = boxObject(box), instance = place(object);
      rtPopMatrix();
      if (dynamic) rtInstanceHint(instance, RT_DYNAMIC);
      rtRender();
      found[dynamic] = cast(all);
      rtDeleteInstance(instance);
      rtDeleteObject(object);
    }
    double worst = 0;
    size_t wrong = 0;
    for (size_t i = 0; i < count; i++) {
      const double rounding = 40 * ulp * 3 * ratio;
      if (all[i].depth < rounding) continue;
      double grazing = 1;
      const double expected = leaves(box, all[i].from, all[i].direction, grazing);
      for (const auto& hits : found) {
        const double t = double(hits[i].t);
        // If rounding makes the ray hit the next face instead, the point must still lie on the box.
        const Vec at = all[i].from + all[i].direction * t;
        const double off =
            std::min(std::fabs(t - expected) * grazing, std::fabs(numeric::depth(box, at)));
        if (!(off <= rounding)) wrong++;
        worst = std::max(worst, off / (3 * ratio * ulp));
      }
    }
    EXPECT_EQ(wrong, 0u) << what << ", worst " << worst;
  });
}

// Queries of all hits and of the nearest point find slivers as closest-hit queries do.
TEST_F(Slivers, AllQueriesSeeThem) {
  Random random(5);
  for (const bool dynamic : {false, true}) {
    const Box box{{5e3, .5, .5}};
    const Matrix m = turned(random, 1e3);
    rtPushMatrix();
    rtLoadIdentity();
    rtMultMatrixd(m.data());
    const RTid instance = place(boxObject(box));
    rtPopMatrix();
    if (dynamic) rtInstanceHint(instance, RT_DYNAMIC);
    rtRender();
    std::vector<RTray> rays;
    std::vector<float> points;
    std::vector<double> away;
    for (int i = 0; i < 500; i++) {
      const Vec at{random(-4e3, 4e3), random(-.4, .4), random(-.4, .4)};
      const Vec from = apply(m, at), d = random.direction();
      rays.push_back({{float(from.x), float(from.y), float(from.z)},
                      0,
                      {float(d.x), float(d.y), float(d.z)},
                      infinity});
      points.insert(points.end(), {float(from.x), float(from.y), float(from.z)});
      away.push_back(numeric::depth(box, at));
    }
    std::vector<uint32_t> counts(rays.size());
    rtCountHits(rays.size(), rays.data(), counts.data());
    std::vector<RTclosest> nearest(rays.size());
    rtClosestPoints(rays.size(), points.data(), infinity, nearest.data());
    for (size_t i = 0; i < rays.size(); i++) {
      EXPECT_EQ(counts[i], 1u) << i;
      // The spacing of floats at 5,000.
      EXPECT_NEAR(double(nearest[i].distance), away[i], 4e-3) << i;
      EXPECT_EQ(nearest[i].instance, instance);
    }
    rtDeleteInstance(instance);
  }
}

// One triangle with its corners as given (no matrix, the camera at the origin). The exact hit
// follows from the numbers alone.
struct Truth {
  long double t = 0, u = 0, v = 0, margin = -1; // margin: the smallest barycentric weight
};
Truth truth(const float* corner, const RTray& ray) {
  long double p[3][3], d[3], w[3], sum = 0;
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 3; j++)
      p[k][j] =
          static_cast<long double>(corner[3 * k + j]) - static_cast<long double>(ray.origin[j]);
  for (int j = 0; j < 3; j++) d[j] = static_cast<long double>(ray.direction[j]);
  for (int k = 0; k < 3; k++) {
    const long double *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
    w[k] = (a[1] * b[2] - a[2] * b[1]) * d[0] + (a[2] * b[0] - a[0] * b[2]) * d[1] +
           (a[0] * b[1] - a[1] * b[0]) * d[2];
    sum += w[k];
  }
  if (sum == 0) return {};
  Truth out{0, w[1] / sum, w[2] / sum, std::min({w[0] / sum, w[1] / sum, w[2] / sum})};
  long double square = 0;
  for (int j = 0; j < 3; j++) {
    square += d[j] * d[j];
    for (int k = 0; k < 3; k++) out.t += w[k] / sum * p[k][j] * d[j];
  }
  out.t /= square;
  return out;
}

TEST_F(Slivers, ATrueHitIsNeverLostAndIsWhereItIs) {
  Random random(77);
  size_t met = 0, lost = 0, invented = 0, off = 0;
  double worst = 0;
  for (int t = 0; t < 2000; t++) {
    const double thin = std::pow(10, random(-6, -2.8));
    const Vec along = random.direction(), up = unit(cross(along, random.direction())),
              normal = cross(along, up);
    const Vec middle = random.direction() * random(0, 2);
    const double corners[3][2] = {
        {-1, 0}, {random(.5, 1), random(0, 1)}, {random(-.5, 1), random(1, 2)}};
    std::vector<float> points;
    for (const auto& c : corners) {
      const Vec p = middle + along * c[0] + up * (thin * c[1]);
      points.insert(points.end(), {float(p.x), float(p.y), float(p.z)});
    }
    const RTid object = rtBeginObject(0);
    const uint32_t index[3] = {0, 1, 2};
    rtVertexPointer(3, RT_FLOAT, 0, points.data());
    rtDrawElements(RT_TRIANGLES, 3, index, 3);
    rtVertexPointer(3, RT_FLOAT, 0, nullptr);
    rtEndObject();
    const RTid instance = place(object);
    rtRender();
    std::vector<RTray> rays;
    for (int i = 0; i < 60; i++) {
      double a = random(0, 1), b = random(0, 1);
      if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
      }
      const float *p = points.data(), *q = p + 3, *r = q + 3;
      double to[3];
      for (int k = 0; k < 3; k++)
        to[k] = (1 - a - b) * double(p[k]) + a * double(q[k]) + b * double(r[k]);
      const double sine = std::pow(10, random(-7, 0)), turn = random(0, 2 * pi);
      const Vec d =
          unit((along * std::cos(turn) + up * std::sin(turn)) + normal * (sine * random.sign()));
      const Vec from = Vec{to[0], to[1], to[2]} - d * random(.1, 3);
      rays.push_back({{float(from.x), float(from.y), float(from.z)},
                      0,
                      {float(d.x), float(d.y), float(d.z)},
                      infinity});
    }
    std::vector<RThit> hits(rays.size());
    rtCastRays(rays.size(), rays.data(), hits.data());
    for (size_t i = 0; i < rays.size(); i++) {
      const Truth is = truth(points.data(), rays[i]);
      const bool found = std::isfinite(hits[i].t);
      if (is.margin > 1e-6 && is.t > 1e-6) {
        met++;
        if (!found) {
          lost++;
          continue;
        }
        const double error =
            std::max({std::fabs(double(static_cast<long double>(hits[i].t) - is.t)),
                      std::fabs(double(static_cast<long double>(hits[i].u) - is.u)),
                      std::fabs(double(static_cast<long double>(hits[i].v) - is.v))});
        worst = std::max(worst, error);
        off += error > 2e-6;
      } else if (is.margin < -1e-6 || is.t < -1e-6) {
        invented += found;
      }
    }
    rtDeleteInstance(instance);
    rtDeleteObject(object);
  }
  EXPECT_GT(met, 10000u);
  EXPECT_EQ(lost, 0u) << "of " << met;
  EXPECT_EQ(off, 0u) << "worst " << worst;
  EXPECT_EQ(invented, 0u);
}

} // namespace
} // namespace numeric
