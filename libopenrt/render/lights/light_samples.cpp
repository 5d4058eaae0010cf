// light_samples.cpp: triangles are sampled by the formulas of SphericalTriangle (spherical.h), in
// single precision. That is enough where the triangle is not seen at a grazing angle and is no
// sliver: directions and pdfs then have the accuracy of the float that holds them. Functions with
// HWY_INLINE return many vectors, which then stay in registers.
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
  const Mask twoSided = points.twoSided ? loadMask(points.twoSided + i) : noLanes();
  return {offsetPoint(load(points.position, i), normal, load(points.error + i)),
          select(twoSided, zero, normal), twoSided};
}

struct Importances { // importances of a node's children for some points
  Lanes each[LightNode::width], sum;
  uint32_t count;
};

HWY_INLINE Importances importancesAt(const LightNode& node, const Receivers& from) {
  const Lanes zero = lanesOf(0);
  const ReceiverLanes<Lanes> to{from.position, from.normal, select(from.twoSided, lanesOf(2), zero),
                                lanesOf(-cosineSlack), lanesOf(cosineSlack)};
  Importances out;
  out.sum = zero;
  out.count = 0;
  for (uint32_t c = 0; c < LightNode::width && node.used[c] > 0; c++, out.count++) {
    const auto all = [&](const float* values) { return lanesOf(values[c]); };
    const LightLanes<Lanes> light{{all(node.center[0]), all(node.center[1]), all(node.center[2])},
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
    out.each[c] = importance(light, to);
    out.sum = out.sum + out.each[c];
  }
  return out;
}

// Computes skyShareOf().
Lanes skyShareAt(float skyIrradiance, Lanes shapes) {
  if (!(skyIrradiance > 0)) return lanesOf(0);
  const Lanes one = lanesOf(1), sky = lanesOf(skyIrradiance);
  const Mask any = shapes > lanesOf(0);
  const Lanes mixed = sky / select(any, sky + shapes, one);
  return select(any, min(max(mixed, lanesOf(leastEmitterShare)), lanesOf(1 - leastEmitterShare)),
                one);
}

struct Choice { // ChosenLights of some points
  Lanes skyShare;
  Bits shape;
  Lanes probability;
};

Choice loadChoice(const ChosenLights& chosen, uint32_t i) {
  return {load(chosen.skyShare + i), load(chosen.shape + i), load(chosen.probability + i)};
}

Choice chooseAt(const LightNode& node, const Receivers& from, float skyIrradiance,
                Lanes randomNumber) {
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const Importances by = importancesAt(node, from);
  const Lanes share = skyShareAt(skyIrradiance, by.sum);
  // The first child whose part of the sum holds the random number; the last one that is possible if
  // rounding leaves none.
  const Lanes others = one - share, pick = randomNumber - share;
  const Lanes rest =
      min(max(pick / select(others > zero, others, one), zero), lanesOf(1 - 0x1p-24f));
  Lanes left = rest * by.sum, chosen = zero;
  Bits shape = bitsOf(~0u);
  Mask found = noLanes();
  for (uint32_t c = 0; c < by.count; c++) {
    const Mask possible = by.each[c] > zero;
    const Mask take = hn::AndNot(found, possible);
    shape = hn::IfThenElse(maskOf(take), bitsOf(node.child[c]), shape);
    chosen = select(take, by.each[c], chosen);
    found = hn::Or(found, hn::And(take, left < by.each[c]));
    left = left - by.each[c];
  }
  const Mask any = by.sum > zero;
  return {share, shape, select(any, chosen / select(any, by.sum, one), zero)};
}

Lanes squareOf(const LaneVec& v) { return dot(v, v); }

struct Triangle { // triangles seen from some points
  // corner: relative to the point. The length of the normal is twice the area.
  LaneVec corner[3], normal;
  Lanes height;   // corner . normal
  Lanes area2;    // squared double area
  Lanes farthest; // squared distance of the farthest corner
  Bits sides;     // ShapeArrays::sides
  Mask far;       // at a large distance compared to the size
  Mask plain;     // single precision is enough
  Mask lit;       // the side towards the point emits
};

HWY_INLINE Triangle triangleAt(const ShapeArrays& shapes, Indices shape, const LaneVec& eye) {
  const LaneVec a = gather(shapes.corner[0], shape), b = gather(shapes.corner[1], shape),
                c = gather(shapes.corner[2], shape);
  const LaneVec first = b - a, second = c - a, third = first - second;
  Triangle t;
  t.normal = cross(first, second);
  t.corner[0] = a - eye;
  t.corner[1] = b - eye;
  t.corner[2] = c - eye;
  t.height = dot(t.corner[0], t.normal);
  const Lanes longest = max(max(squareOf(first), squareOf(second)), squareOf(third));
  const Lanes square[3] = {squareOf(t.corner[0]), squareOf(t.corner[1]), squareOf(t.corner[2])};
  const Lanes nearest = min(min(square[0], square[1]), square[2]);
  t.farthest = max(max(square[0], square[1]), square[2]);
  t.far = hn::And(nearest > lanesOf(4) * longest, t.farthest < lanesOf(2) * nearest);
  t.area2 = squareOf(t.normal);
  // No sliver, not seen at a grazing angle from the nearest corner, and of a moderate size.
  t.plain = hn::And(hn::And(t.area2 > lanesOf(1e-4f) * longest * longest,
                            t.height * t.height > lanesOf(1e-6f) * t.area2 * nearest),
                    hn::And(hn::And(longest > lanesOf(1e-8f), t.farthest < lanesOf(1e8f)),
                            nearest > lanesOf(1e-6f) * longest));
  t.sides = gather(shapes.sides, shape);
  t.plain = hn::AndNot(hasBits(t.sides, ShapeArrays::sphere), t.plain);
  const Mask front = t.height < lanesOf(0);
  t.lit = hn::Or(hn::And(front, hasBits(t.sides, ShapeArrays::front)),
                 hn::AndNot(front, hasBits(t.sides, ShapeArrays::back)));
  return t;
}

struct SampledDirection {
  LaneVec direction;
  Lanes distance, pdf;
};

// Returns the squared distance over the projected area.
Lanes pdfByArea(const Triangle& t, const LaneVec& direction, Lanes distance) {
  return lanesOf(2) * distance * distance / abs(dot(t.normal, direction));
}

// A triangle at a large distance compared to its size is sampled uniformly by area.
SampledDirection sampleFar(const Triangle& t, Lanes u, Lanes v) {
  const Lanes one = lanesOf(1), root = sqrt(u);
  const LaneVec to =
      t.corner[0] * (one - root) + t.corner[1] * (root * (one - v)) + t.corner[2] * (root * v);
  const Lanes distance = sqrt(squareOf(to));
  const LaneVec direction = to * (one / distance);
  return {direction, distance, pdfByArea(t, direction, distance)};
}

struct SphericalTriangles { // the terms of SphericalTriangle
  LaneVec unit[3];
  Lanes volume, others, first, halfAngle;
};

HWY_INLINE SphericalTriangles project(const Triangle& t) {
  const Lanes one = lanesOf(1);
  SphericalTriangles s;
  Lanes size = one;
  for (int c = 0; c < 3; c++) {
    const Lanes length = sqrt(squareOf(t.corner[c]));
    s.unit[c] = t.corner[c] * (one / length);
    size = size * length;
  }
  s.volume = abs(t.height) / size;
  s.others = dot(s.unit[0], s.unit[2]) + dot(s.unit[1], s.unit[2]);
  s.first = one + dot(s.unit[0], s.unit[1]);
  s.halfAngle = atan2Positive(s.volume, s.others + s.first);
  return s;
}

Lanes pdfBySolidAngle(const SphericalTriangles& s) { return lanesOf(0.5f) / s.halfAngle; }

// Selects the point on the arc from the first corner to the last that cuts off the fraction u of
// the solid angle. Then selects a point on the arc from the second corner to that point.
SampledDirection sampleNear(const Triangle& t, Lanes u, Lanes v) {
  const Lanes zero = lanesOf(0), one = lanesOf(1), two = lanesOf(2);
  const SphericalTriangles seen = project(t);
  const LaneVec* unit = seen.unit;
  Lanes s, c;
  sinCos(u * seen.halfAngle, s, c);
  const Lanes x = seen.volume * c - seen.others * s, y = seen.first * s;
  const LaneVec r = unit[0] * x + unit[2] * y;
  const LaneVec end = r * (two * dot(unit[0], r) / squareOf(r)) - unit[0];
  const LaneVec across = end - unit[1] * dot(unit[1], end);
  // 1 - cosine of the second arc, computed from its chord.
  const Lanes span = lanesOf(0.5f) * squareOf(end - unit[1]);
  const Lanes below = v * span, sine = sqrt(max(below * (two - below), zero));
  const LaneVec to = unit[1] * (one - below) + across * (sine / sqrt(squareOf(across)));
  const LaneVec direction = to * (one / sqrt(squareOf(to)));
  return {direction, t.height / dot(t.normal, direction), pdfBySolidAngle(seen)};
}

SampledDirection selectSample(Mask condition, const SampledDirection& a,
                              const SampledDirection& b) {
  return {select(condition, a.direction, b.direction), select(condition, a.distance, b.distance),
          select(condition, a.pdf, b.pdf)};
}

SampledDirection sampleTriangle(const Triangle& t, Lanes u, Lanes v) {
  if (hn::AllTrue(LanesTag(), t.far)) return sampleFar(t, u, v);
  const SampledDirection near = sampleNear(t, u, v);
  return hn::AllFalse(LanesTag(), t.far) ? near : selectSample(t.far, sampleFar(t, u, v), near);
}

// Returns the end of shadow rays by the bounds of shadowRayEnd() (sampled_points.cpp).
Lanes endBefore(const Triangle& t, const SampledDirection& to) {
  // Farthest distance over the cosine at the triangle.
  const Lanes over = sqrt(t.farthest * t.area2) / abs(dot(t.normal, to.direction));
  const Lanes error = lanesOf(24 * 0x1p-24f) * over + lanesOf(8 * 0x1p-24f) * to.distance,
              most = to.distance * lanesOf(0x1p-10f);
  return to.distance - select(error < most, error, most);
}

// Returns the numbers of the shapes as indices, 0 where the condition does not hold.
Indices indicesWhere(Mask condition, Bits shape) {
  return hn::BitCast(hn::RebindToSigned<LanesTag>(), hn::IfThenElseZero(maskOf(condition), shape));
}

// Returns the points whose samples are left to other code.
Mask sampleAt(const ShapeArrays& shapes, const LightPoints& points, const Receivers& from,
              const Choice& choice, uint32_t i, const SampledLights& out) {
  const Lanes zero = lanesOf(0), u = load(points.u + i), v = load(points.v + i);
  const Mask wanted = load(points.wanted + i) > zero,
             fromSky = load(points.pick + i) < choice.skyShare;
  const Mask any = hn::And(hn::AndNot(fromSky, wanted), choice.probability > zero);
  const Triangle t = triangleAt(shapes, indicesWhere(any, choice.shape), from.position);
  const SampledDirection to = sampleTriangle(t, u, v);
  const Lanes selection = (lanesOf(1) - choice.skyShare) * choice.probability,
              pdf = selection * to.pdf;
  const Mask above = hn::Or(from.twoSided, dot(to.direction, from.normal) > zero);
  const Mask valid = hn::And(hn::And(hn::And(t.lit, above), to.distance > zero),
                             hn::And(isFinite(to.distance), isFinite(pdf)));
  const Mask inDouble = hn::AndNot(t.plain, any), sky = hn::And(wanted, fromSky);
  const Mask sampled = hn::And(hn::And(any, t.plain), valid);
  store(to.direction, out.direction, i);
  store(to.distance, out.distance + i);
  const Mask unknown = hn::Or(from.twoSided, hasBits(t.sides, ShapeArrays::instanced));
  store(select(unknown, lanesOf(-1), endBefore(t, to)), out.end + i);
  const Lanes leftPdf = select(inDouble, selection, select(sky, choice.skyShare, zero));
  store(select(sampled, pdf, leftPdf), out.pdf + i);
  store(choice.shape, out.shape + i);
  store(hn::Or(bitsWhere(inDouble, SampledLights::inDouble), bitsWhere(sky, SampledLights::sky)),
        out.left + i);
  return hn::And(hn::Or(inDouble, sky), presentFrom(i, points.count));
}

// Returns the pdf of a light sample in the direction of each found shape; -1 where that is left to
// double precision.
Lanes pdfAt(const LightNode& root, const ShapeArrays& shapes, const FoundShapes& found, uint32_t i,
            float skyIrradiance) {
  const Lanes zero = lanesOf(0);
  const LaneVec normal = load(found.normal, i), direction = load(found.direction, i);
  const Mask twoSided = hn::And(hn::And(normal.x == zero, normal.y == zero), normal.z == zero);
  const Receivers from{load(found.position, i), normal, twoSided};
  const Bits shape = load(found.shape + i);
  const Importances by = importancesAt(root, from);
  Lanes own = zero;
  for (uint32_t c = 0; c < by.count; c++)
    own = select(maskOf(hn::Eq(shape, bitsOf(root.child[c]))), by.each[c], own);
  const Triangle t =
      triangleAt(shapes, indicesWhere(presentFrom(i, found.count), shape), from.position);
  Lanes alone = pdfByArea(t, direction, t.height / dot(t.normal, direction));
  if (!hn::AllTrue(LanesTag(), t.far)) alone = select(t.far, alone, pdfBySolidAngle(project(t)));
  const Lanes selection = (lanesOf(1) - skyShareAt(skyIrradiance, by.sum)) * (own / by.sum);
  const Lanes pdf = select(hn::And(t.lit, own > zero), selection * alone, zero);
  return select(t.plain, pdf, lanesOf(-1));
}

} // namespace

void chooseFromRoot(const LightNode& root, const LightPoints& points, float skyIrradiance,
                    const ChosenLights& out) {
  for (uint32_t i = 0; i < points.count; i += width()) {
    const Choice choice =
        chooseAt(root, loadReceivers(points, i), skyIrradiance, load(points.pick + i));
    store(choice.skyShare, out.skyShare + i);
    store(choice.shape, out.shape + i);
    store(choice.probability, out.probability + i);
  }
}

bool sampleShapes(const ShapeArrays& shapes, const LightPoints& points, const ChosenLights& chosen,
                  const SampledLights& out) {
  Mask left = noLanes();
  for (uint32_t i = 0; i < points.count; i += width())
    left = hn::Or(
        left, sampleAt(shapes, points, loadReceivers(points, i), loadChoice(chosen, i), i, out));
  return !hn::AllFalse(LanesTag(), left);
}

bool sampleFromRoot(const LightNode& root, const ShapeArrays& shapes, const LightPoints& points,
                    float skyIrradiance, const SampledLights& out) {
  Mask left = noLanes();
  for (uint32_t i = 0; i < points.count; i += width()) {
    const Receivers from = loadReceivers(points, i);
    const Choice choice = chooseAt(root, from, skyIrradiance, load(points.pick + i));
    left = hn::Or(left, sampleAt(shapes, points, from, choice, i, out));
  }
  return !hn::AllFalse(LanesTag(), left);
}

void pdfFromRoot(const LightNode& root, const ShapeArrays& shapes, const FoundShapes& found,
                 float skyIrradiance, float* pdf) {
  for (uint32_t i = 0; i < found.count; i += width())
    store(pdfAt(root, shapes, found, i, skyIrradiance), pdf + i);
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {

void SampledLights::allocate(Arena& arena, uint32_t capacity) {
  const uint32_t n = padded(capacity);
  for (auto* a : {&direction[0], &direction[1], &direction[2], &distance, &end, &pdf})
    *a = arena.take<float>(n);
  shape = arena.take<uint32_t>(n);
  left = arena.take<uint32_t>(n);
}

void FoundShapes::allocate(Arena& arena, uint32_t capacity) {
  const uint32_t n = padded(capacity);
  for (auto* group : {position, normal, direction})
    for (int k = 0; k < 3; k++) group[k] = arena.take<float>(n);
  shape = arena.take<uint32_t>(n);
  count = 0;
}

HWY_EXPORT(chooseFromRoot);
HWY_EXPORT(sampleShapes);
HWY_EXPORT(sampleFromRoot);
HWY_EXPORT(pdfFromRoot);
void chooseFromRoot(const LightNode& root, const LightPoints& points, float skyIrradiance,
                    const ChosenLights& out) {
  HWY_DYNAMIC_DISPATCH(chooseFromRoot)(root, points, skyIrradiance, out);
}
bool sampleShapes(const ShapeArrays& shapes, const LightPoints& points, const ChosenLights& chosen,
                  const SampledLights& out) {
  return HWY_DYNAMIC_DISPATCH(sampleShapes)(shapes, points, chosen, out);
}
bool sampleFromRoot(const LightNode& root, const ShapeArrays& shapes, const LightPoints& points,
                    float skyIrradiance, const SampledLights& out) {
  return HWY_DYNAMIC_DISPATCH(sampleFromRoot)(root, shapes, points, skyIrradiance, out);
}
void pdfFromRoot(const LightNode& root, const ShapeArrays& shapes, const FoundShapes& found,
                 float skyIrradiance, float* pdf) {
  HWY_DYNAMIC_DISPATCH(pdfFromRoot)(root, shapes, found, skyIrradiance, pdf);
}
} // namespace openrt
#endif
