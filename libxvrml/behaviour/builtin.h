// builtin.h: the behaviours of the standard's nodes, one function per file. builtin.cpp calls them
// all.
#pragma once

#include <functional>

#include "xvrml/behaviour.h"

namespace xvrml {

using AddBehaviour = std::function<void(const NodeType& type, const Behaviour& behaviour)>;

void addBuiltinBehaviours(const AddBehaviour& add);

void addBindingBehaviours(const AddBehaviour& add); // Viewpoint, NavigationInfo, Background, Fog
// TouchSensor, PlaneSensor, SphereSensor, CylinderSensor
void addPointingBehaviours(const AddBehaviour& add);
// ProximitySensor, TransformSensor, VisibilitySensor
void addRegionBehaviours(const AddBehaviour& add);
void addInlineBehaviours(const AddBehaviour& add); // set_url loads the content
// addChildren, removeChildren; the level of an LOD
void addGroupingBehaviours(const AddBehaviour& add);
void addInterpolatorBehaviours(const AddBehaviour& add);
void addSplineInterpolatorBehaviours(const AddBehaviour& add);
void addSquadInterpolatorBehaviours(const AddBehaviour& add);
void addNurbsInterpolatorBehaviours(const AddBehaviour& add);
void addEaseBehaviours(const AddBehaviour& add);
void addEventUtilityBehaviours(const AddBehaviour& add); // filters and triggers
void addSequencerBehaviours(const AddBehaviour& add);
void addFollowerBehaviours(const AddBehaviour& add);  // chasers and dampers
void addKeySensorBehaviours(const AddBehaviour& add); // KeySensor, StringSensor
void addLoadSensorBehaviours(const AddBehaviour& add);
void addTimeSensorBehaviours(const AddBehaviour& add);
void addAudioClipBehaviours(const AddBehaviour& add);
void addMovieTextureBehaviours(const AddBehaviour& add);
void addTextBehaviours(const AddBehaviour& add);
void addMotionBehaviours(const AddBehaviour& add); // HAnimMotion, HAnimHumanoid
void addParticleBehaviours(const AddBehaviour& add); // particles/particle_system.cpp

} // namespace xvrml
