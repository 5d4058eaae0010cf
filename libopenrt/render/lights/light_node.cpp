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
      {all(receiver.place[0]), all(receiver.place[1]), all(receiver.place[2])},
      {all(receiver.normal[0]), all(receiver.normal[1]), all(receiver.normal[2])},
      all(receiver.facing),
      all(receiver.cut),
      all(receiver.least)};
  for (size_t i = 0; i < LightNode::width; i += hn::Lanes(tag)) {
    const auto some = [&](const float* values) { return hn::LoadU(tag, values + i); };
    const LightLanes<V> light{{some(node.centre[0]), some(node.centre[1]), some(node.centre[2])},
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

LightReceiver::LightReceiver(const float from[3], const float* side, ReceiverSide meaning) {
  for (int k = 0; k < 3; k++) {
    place[k] = from[k];
    normal[k] = side ? side[k] : 0;
  }
  facing = side ? 0 : 2;
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
