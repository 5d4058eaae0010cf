#include "behaviour/builtin.h"

namespace xvrml {

void addBuiltinBehaviours(const AddBehaviour& add) {
  addBindingBehaviours(add);
  addPointingBehaviours(add);
  addRegionBehaviours(add);
  addInlineBehaviours(add);
  addGroupingBehaviours(add);
  addInterpolatorBehaviours(add);
  addTimeSensorBehaviours(add);
  addAudioClipBehaviours(add);
  addMovieTextureBehaviours(add);
}

} // namespace xvrml
