// builtin.h: the behaviours of the standard's nodes, one function a file; the list is in
// builtin.cpp.
#pragma once

#include <functional>

#include "xvrml/behaviour.h"

namespace xvrml {

using AddBehaviour = std::function<void(const NodeType& type, const Behaviour& behaviour)>;

void addBuiltinBehaviours(const AddBehaviour& add);

void addBindingBehaviours(const AddBehaviour& add); // Viewpoint, NavigationInfo, Background, Fog
void addPointingBehaviours(
    const AddBehaviour& add); // TouchSensor, PlaneSensor, SphereSensor, CylinderSensor
void addRegionBehaviours(const AddBehaviour& add);   // ProximitySensor, VisibilitySensor
void addInlineBehaviours(const AddBehaviour& add);   // set_url loads
void addGroupingBehaviours(const AddBehaviour& add); // addChildren, removeChildren
void addInterpolatorBehaviours(const AddBehaviour& add);
void addTimeSensorBehaviours(const AddBehaviour& add);
void addAudioClipBehaviours(const AddBehaviour& add);
void addMovieTextureBehaviours(const AddBehaviour& add);

} // namespace xvrml
