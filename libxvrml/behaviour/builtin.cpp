#include "behaviour/builtin.h"

namespace xvrml {

void addBuiltinBehaviours(const AddBehaviour& add) {
  addBindingBehaviours(add);
  addPointingBehaviours(add);
  addRegionBehaviours(add);
  addInlineBehaviours(add);
  addGroupingBehaviours(add);
  addInterpolatorBehaviours(add);
  addSplineInterpolatorBehaviours(add);
  addSquadInterpolatorBehaviours(add);
  addNurbsInterpolatorBehaviours(add);
  addEaseBehaviours(add);
  addEventUtilityBehaviours(add);
  addSequencerBehaviours(add);
  addFollowerBehaviours(add);
  addKeySensorBehaviours(add);
  addLoadSensorBehaviours(add);
  addTimeSensorBehaviours(add);
  addAudioClipBehaviours(add);
  addMovieTextureBehaviours(add);
  addTextBehaviours(add);
  addMotionBehaviours(add);
  addParticleBehaviours(add);
}

} // namespace xvrml
