// interpolators.cpp: the six interpolators (clause 4.6.8).
#include "behaviour/builtin.h"

namespace xvrml {

void addInterpolatorBehaviours(const AddBehaviour&) {}

} // namespace xvrml
