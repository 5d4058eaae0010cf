// light_samples.cpp: triangles are sampled by the formulas of SphericalTriangle (spherical.h), in
// single precision. That is enough where the triangle is not seen at a grazing angle and is no
// sliver: directions and pdfs then have the accuracy of the float that holds them.
#include "render/lights/light_samples.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/lights/light_samples.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/directions-inl.h"
#include "render/lanes/math-inl.h"
#include "render/lights/light_importance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

struct Receivers {          // the points of some lanes
  LaneVec position, normal; // normal: 0 if light counts from both sides
  Mask twoSided;
};

Receivers loadReceivers(const LightPoints& points, uint32_t i) {
  const LaneVec normal = load(points.normal, i), zero = {lanesOf(0), lanesOf(0), lanesOf(0)};
  const Mask twoSided = loadMask(points.twoSided + i);
  return {offsetPoint(load(points.position, i), normal, load(points.error + i)),
          select(twoSided, zero, normal), twoSided};
}

void chooseAt(const LightNode& node, const LightPoints& points, float skyIrradiance, uint32_t i,
              const ChosenLights& out) {
  const Receivers from = loadReceivers(points, i);
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const ReceiverLanes<Lanes> to{from.position, from.normal, select(from.twoSided, lanesOf(2), zero),
                                lanesOf(-cosineSlack), lanesOf(cosineSlack)};
  Lanes each[LightNode::width], sum = zero;
  uint32_t count = 0;
  for (uint32_t c = 0; c < LightNode::width && node.used[c] > 0; c++, count++) {
    const auto all = [&](const float* values) { return lanesOf(values[c]); };
    const LightLanes<Lanes> light{{all(node.centre[0]), all(node.centre[1]), all(node.centre[2])},
                                  {all(node.axis[0]), all(node.axis[1]), all(node.axis[2])},
                                  all(node.radius2),
                                  all(node.reach2),
                                  all(node.cosine),
                                  all(node.sine),
                                  all(node.beyond),
                                  all(node.both),
                                  all(node.intensity),
                                  all(node.irradiance),
                                  all(node.used)};
    each[c] = importance(light, to);
    sum = sum + each[c];
  }
  // The first child whose part of the sum holds the random number; the last one that is possible if
  // rounding leaves none.
  const Mask any = sum > zero;
  const Lanes sky = lanesOf(skyIrradiance), least = lanesOf(0.0625f), most = lanesOf(0.9375f);
  const Lanes mixed = min(max(sky / select(any, sky + sum, one), least), most);
  const Lanes alone = lanesOf(skyIrradiance > 0 ? 1 : 0);
  const Lanes share = skyIrradiance > 0 ? select(any, mixed, alone) : zero;
  store(share, out.skyShare + i);
  const Lanes others = one - share, pick = load(points.pick + i) - share;
  const Lanes rest =
      min(max(pick / select(others > zero, others, one), zero), lanesOf(1 - 0x1p-24f));
  Lanes left = rest * sum, chosen = zero;
  Bits shape = bitsOf(~0u);
  Mask found = sum < zero; // false everywhere
  for (uint32_t c = 0; c < count; c++) {
    const Mask possible = each[c] > zero;
    const Mask take = hn::AndNot(found, possible);
    shape = hn::IfThenElse(hn::RebindMask(BitsTag(), take), bitsOf(node.child[c]), shape);
    chosen = select(take, each[c], chosen);
    found = hn::Or(found, hn::And(take, left < each[c]));
    left = left - each[c];
  }
  store(shape, out.shape + i);
  store(select(any, chosen / select(any, sum, one), zero), out.probability + i);
}

Lanes squareOf(const LaneVec& v) { return dot(v, v); }

// A triangle at a large distance compared to its size is sampled uniformly by area.
void sampleFar(const LaneVec (&corner)[3], const LaneVec& normal, Lanes u, Lanes v,
               LaneVec& direction, Lanes& distance, Lanes& pdf) {
  const Lanes one = lanesOf(1), root = sqrt(u);
  const LaneVec to =
      corner[0] * (one - root) + corner[1] * (root * (one - v)) + corner[2] * (root * v);
  distance = sqrt(squareOf(to));
  direction = to * (one / distance);
  // Squared distance over the projected area.
  pdf = lanesOf(2) * distance * distance / abs(dot(normal, direction));
}

// Selects the point on the arc from the first corner to the last that cuts off the fraction u of
// the solid angle. Then selects a point on the arc from the second corner to that point.
void sampleNear(const LaneVec (&corner)[3], const LaneVec& normal, Lanes height, Lanes u, Lanes v,
                LaneVec& direction, Lanes& distance, Lanes& pdf) {
  const Lanes zero = lanesOf(0), one = lanesOf(1), two = lanesOf(2);
  Lanes size = one;
  LaneVec unit[3];
  for (int c = 0; c < 3; c++) {
    const Lanes length = sqrt(squareOf(corner[c]));
    unit[c] = corner[c] * (one / length);
    size = size * length;
  }
  const Lanes volume = abs(height) / size;
  const Lanes others = dot(unit[0], unit[2]) + dot(unit[1], unit[2]),
              first = one + dot(unit[0], unit[1]);
  const Lanes halfAngle = atan2Positive(volume, others + first);
  pdf = lanesOf(0.5f) / halfAngle;
  Lanes s, c;
  sinCos(u * halfAngle, s, c);
  const Lanes x = volume * c - others * s, y = first * s;
  const LaneVec r = unit[0] * x + unit[2] * y;
  const LaneVec end = r * (two * dot(unit[0], r) / squareOf(r)) - unit[0];
  const LaneVec across = end - unit[1] * dot(unit[1], end);
  // 1 - cosine of the second arc, computed from its chord.
  const Lanes span = lanesOf(0.5f) * squareOf(end - unit[1]);
  const Lanes below = v * span, sine = sqrt(max(below * (two - below), zero));
  const LaneVec to = unit[1] * (one - below) + across * (sine / sqrt(squareOf(across)));
  direction = to * (one / sqrt(squareOf(to)));
  distance = height / dot(normal, direction);
}

void sampleAt(const ShapeArrays& shapes, const LightPoints& points, uint32_t i,
              const ChosenLights& chosen, const SampledLights& out) {
  const Receivers from = loadReceivers(points, i);
  const Lanes zero = lanesOf(0), probability = load(chosen.probability + i);
  const Mask any = probability > zero;
  const hn::RebindToSigned<LanesTag> integers;
  const auto shape = hn::BitCast(
      integers, hn::IfThenElseZero(hn::RebindMask(BitsTag(), any), load(chosen.shape + i)));
  const LaneVec a = gather(shapes.corner[0], shape), b = gather(shapes.corner[1], shape),
                c = gather(shapes.corner[2], shape);
  const LaneVec first = b - a, second = c - a, third = first - second;
  const LaneVec normal = cross(first, second);
  const LaneVec corner[3] = {a - from.position, b - from.position, c - from.position};
  const Lanes height = dot(corner[0], normal);
  const Lanes longest = max(max(squareOf(first), squareOf(second)), squareOf(third));
  const Lanes square[3] = {squareOf(corner[0]), squareOf(corner[1]), squareOf(corner[2])};
  const Lanes nearest = min(min(square[0], square[1]), square[2]),
              farthest = max(max(square[0], square[1]), square[2]);
  const Mask far = hn::And(nearest > lanesOf(4) * longest, farthest < lanesOf(2) * nearest);
  const Lanes area2 = squareOf(normal); // squared double area
  // No sliver, not seen at a grazing angle from the nearest corner, and of a moderate size.
  const Mask plain = hn::And(hn::And(area2 > lanesOf(1e-4f) * longest * longest,
                                     height * height > lanesOf(1e-6f) * area2 * nearest),
                             hn::And(hn::And(longest > lanesOf(1e-8f), farthest < lanesOf(1e8f)),
                                     nearest > lanesOf(1e-6f) * longest));
  const Bits sides = hn::BitCast(
      BitsTag(), hn::GatherIndex(integers, reinterpret_cast<const int32_t*>(shapes.sides), shape));
  const auto has = [&](uint32_t bits) {
    return hn::RebindMask(LanesTag(), hn::Ne(hn::And(sides, bitsOf(bits)), bitsOf(0)));
  };
  const Mask sphere = has(ShapeArrays::sphere);
  const Mask lit = hn::Or(hn::And(height < zero, has(1)), hn::AndNot(height < zero, has(2)));
  const Lanes u = load(points.u + i), v = load(points.v + i);
  LaneVec direction, nearDirection;
  Lanes distance, pdf, nearDistance, nearPdf;
  sampleFar(corner, normal, u, v, direction, distance, pdf);
  if (!hn::AllTrue(LanesTag(), far)) {
    sampleNear(corner, normal, height, u, v, nearDirection, nearDistance, nearPdf);
    direction = select(far, direction, nearDirection);
    distance = select(far, distance, nearDistance);
    pdf = select(far, pdf, nearPdf);
  }
  const Mask side = hn::Or(from.twoSided, dot(direction, from.normal) > zero);
  const Mask valid = hn::And(hn::And(hn::And(any, lit), hn::And(side, distance > zero)),
                             hn::And(isFinite(distance), isFinite(pdf)));
  store(direction, out.direction, i);
  store(distance, out.distance + i);
  // The bounds of shadowRayEnd() (sampled_points.cpp).
  const Lanes cosine = abs(dot(normal, direction)) / sqrt(area2);
  const Lanes error = lanesOf(24 * 0x1p-24f) * sqrt(farthest) / cosine +
                      lanesOf(8 * 0x1p-24f) * distance,
              most = distance * lanesOf(0x1p-10f);
  const Lanes end = distance - select(error < most, error, most);
  store(select(has(ShapeArrays::instanced), lanesOf(-1), end), out.end + i);
  store(select(valid, pdf, zero), out.pdf + i);
  store(bitsWhere(hn::And(any, hn::Or(sphere, hn::Not(plain))), 1), out.exact + i);
}

} // namespace

void chooseFromRoot(const LightNode& root, const LightPoints& points, float skyIrradiance,
                    const ChosenLights& out) {
  for (uint32_t i = 0; i < points.count; i += width())
    chooseAt(root, points, skyIrradiance, i, out);
}

void sampleShapes(const ShapeArrays& shapes, const LightPoints& points, const ChosenLights& chosen,
                  const SampledLights& out) {
  for (uint32_t i = 0; i < points.count; i += width()) sampleAt(shapes, points, i, chosen, out);
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {
HWY_EXPORT(chooseFromRoot);
HWY_EXPORT(sampleShapes);
void chooseFromRoot(const LightNode& root, const LightPoints& points, float skyIrradiance,
                    const ChosenLights& out) {
  HWY_DYNAMIC_DISPATCH(chooseFromRoot)(root, points, skyIrradiance, out);
}
void sampleShapes(const ShapeArrays& shapes, const LightPoints& points, const ChosenLights& chosen,
                  const SampledLights& out) {
  HWY_DYNAMIC_DISPATCH(sampleShapes)(shapes, points, chosen, out);
}
} // namespace openrt
#endif
