// light_importance-inl.h: the importance of lights for points, as a formula over vector lanes: the
// lanes are the children of one node (light_node.cpp), or the points (light_samples.cpp).

#if defined(OPENRT_LIGHT_IMPORTANCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OPENRT_LIGHT_IMPORTANCE_INL_H
#undef OPENRT_LIGHT_IMPORTANCE_INL_H
#else
#define OPENRT_LIGHT_IMPORTANCE_INL_H
#endif

#include "render/lanes/lanes-inl.h"
#include "render/lights/light_node.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

// The fields of LightNode and LightReceiver.
template <class V> struct LightLanes {
  Vec3<V> center, axis;
  V radius2, reach2, cosine, sine, beyond, both, intensity, irradiance, used;
};
template <class V> struct ReceiverLanes {
  Vec3<V> place, normal;
  V facing, cut, least;
};

// Tolerance of cosines, so that bounds hold despite rounding.
inline constexpr float cosineSlack = 1e-5f;

// Returns a bound of the light's irradiance at a point that faces the light, except for the clamped
// distance near the light's bounding sphere.
template <class V> inline V importance(const LightLanes<V>& light, const ReceiverLanes<V>& to) {
  const V zero = constant<V>(0), one = constant<V>(1), slack = constant<V>(cosineSlack);
  const Vec3<V> d = to.place - light.center;
  const V square = dot(d, d), radius2 = light.radius2;
  const auto within = square <= radius2 * constant<V>(1 + cosineSlack);
  const V inverse = one / sqrt(select(within, one, square));
  // The cone about the box as seen from the point.
  const V cosBox = sqrt(max(one - radius2 * inverse * inverse, zero)) - slack;
  const V sinBox = sqrt(max(one - cosBox * cosBox, zero));
  // The direction from the box to the point that is nearest to the cone of normals.
  const V along = dot(d, light.axis) * inverse;
  const V axial = max(along, (zero - along) * light.both - (one - light.both) * constant<V>(2));
  const V across = sqrt(max(one - axial * axial, zero));
  const V cosLess = axial * light.cosine + across * light.sine,
          sinLess = across * light.cosine - axial * light.sine;
  const auto inCone = axial > light.cosine;
  const V cosX = select(inCone, one, cosLess), sinX = select(inCone, zero, sinLess);
  const V leaves = select(hn::Or(cosX > cosBox, within), one, cosX * cosBox + sinX * sinBox);
  const V leaving = select(leaves < light.beyond - slack, zero, max(leaves, slack));
  // The arriving direction that is nearest to the receiver's normal.
  const V facing = to.facing - dot(d, to.normal) * inverse;
  const V aside = sqrt(max(one - facing * facing, zero));
  const V arrives = select(hn::Or(facing > cosBox, within), one, facing * cosBox + aside * sinBox);
  const V arriving = select(arrives < to.cut, zero, max(arrives, to.least));
  const V falling = light.intensity / max(max(square, radius2), constant<V>(1e-37f));
  const V strength = min(max(falling + light.irradiance, constant<V>(1e-30f)), constant<V>(1e30f));
  const V lit = select(square <= light.reach2, light.used, zero);
  return lit * leaving * arriving * strength;
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#endif
