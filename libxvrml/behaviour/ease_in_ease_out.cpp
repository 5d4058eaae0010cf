// ease_in_ease_out.cpp: EaseInEaseOut (ISO/IEC 19775-1 19.4.4): a fraction that starts and stops
// smoothly at each key.
#include <algorithm>
#include <cmath>

#include "behaviour/builtin.h"
#include "behaviour/ease.h"
#include "behaviour/keys.h"
#include "behaviour/named_fields.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// Sends the part of its interval in which a fraction lies, eased by the second number of the key
// before and the first number of the key after. Outside of the keys it is 0 or 1.
void receive(Events& events, Node& node, const FieldInfo& in, const Value& value) {
  static const FieldInfo& out = fieldOf<nodes::EaseInEaseOut>("modifiedFraction_changed");
  const auto& ease = static_cast<const nodes::EaseInEaseOut&>(node);
  const size_t count = std::min(ease.key.size(), ease.easeInEaseOut.size());
  if (!isField<"set_fraction">(node, in) || count == 0 || std::isnan(std::get<SFFloat>(value)))
    return;
  const float fraction = std::get<SFFloat>(value);
  const KeyPosition place = locate(ease.key.data(), count, fraction);
  if (place.left + 1 >= count)
    events.send(node, out, count > 1 || fraction > ease.key[0] ? 1.0f : 0.0f);
  else
    events.send(
        node, out,
        eased(place.t, ease.easeInEaseOut[place.left].y, ease.easeInEaseOut[place.left + 1].x));
}

} // namespace

void addEaseBehaviours(const AddBehaviour& add) {
  add(nodes::EaseInEaseOut::nodeType(), {.receive = receive});
}

} // namespace xvrml
