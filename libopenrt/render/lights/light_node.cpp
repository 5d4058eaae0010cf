#include "render/lights/light_node.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/lights/light_node.cpp"
#include <hwy/foreach_target.h>

#include "render/lights/light_importance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {

// The lanes are the children of the node.
void importances(const LightNode& node, const LightReceiver& receiver,
                 float out[LightNode::width]) {
  const hn::CappedTag<float, LightNode::width> tag;
  using V = hn::Vec<decltype(tag)>;
  const auto all = [&](float value) { return hn::Set(tag, value); };
  const ReceiverLanes<V> to{
      {all(receiver.place.x), all(receiver.place.y), all(receiver.place.z)},
      {all(receiver.normal.x), all(receiver.normal.y), all(receiver.normal.z)},
      all(receiver.facing),
      all(receiver.cut),
      all(receiver.least)};
  for (size_t i = 0; i < LightNode::width; i += hn::Lanes(tag)) {
    const auto some = [&](const float* values) { return hn::LoadU(tag, values + i); };
    const LightLanes<V> light{{some(node.center[0]), some(node.center[1]), some(node.center[2])},
                              {some(node.axis[0]), some(node.axis[1]), some(node.axis[2])},
                              some(node.radius2),
                              some(node.reach2),
                              some(node.cosine),
                              some(node.sine),
                              some(node.beyond),
                              some(node.both),
                              some(node.intensity),
                              some(node.irradiance),
                              some(node.used)};
    hn::StoreU(importance(light, to), tag, out + i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {

LightReceiver::LightReceiver(const Vec3f& from, const Vec3f& side, ReceiverSide meaning)
    : place(from), normal(side) {
  facing = side == Vec3f() ? 2 : 0;
  cut = meaning == ReceiverSide::only ? -1e-5f : -2;
  least = meaning == ReceiverSide::only ? 1e-5f : 0.1f;
}

HWY_EXPORT(importances);
void importances(const LightNode& node, const LightReceiver& receiver,
                 float out[LightNode::width]) {
  HWY_DYNAMIC_DISPATCH(importances)(node, receiver, out);
}

} // namespace openrt
#endif
