#include "script/abstract_types.h"

#include <algorithm>

#include "xvrml/world.h"

namespace xvrml {
namespace {

struct Row {
  std::string_view role, type;
};

// In the order of inheritance: a type stands behind those that it inherits from (19775-1 4.4.2.3).
constexpr Row rows[] = {{"appearance", "X3DAppearanceNode"},
                        {"material", "X3DMaterialNode"},
                        {"texture", "X3DTextureNode"},
                        {"environmentTexture", "X3DEnvironmentTextureNode"},
                        {"texture3D", "X3DTexture3DNode"},
                        {"textureTransform", "X3DTextureTransformNode"},
                        {"fontStyle", "X3DFontStyleNode"},
                        {"geometry", "X3DGeometryNode"},
                        {"composedGeometry", "X3DComposedGeometryNode"},
                        {"parametric", "X3DParametricGeometryNode"},
                        {"nurbsSurface", "X3DNurbsSurfaceGeometryNode"},
                        {"controlCurve", "X3DNurbsControlCurveNode"},
                        {"coordinate", "X3DCoordinateNode"},
                        {"color", "X3DColorNode"},
                        {"normal", "X3DNormalNode"},
                        {"textureCoordinate", "X3DTextureCoordinateNode"},
                        {"audio", "X3DSoundSourceNode"},
                        {"displacer", "X3DGeometricPropertyNode"},
                        {"particleEmitter", "X3DParticleEmitterNode"},
                        {"particlePhysics", "X3DParticlePhysicsModelNode"},
                        {"fogCoordinate", "X3DGeometricPropertyNode"},
                        {"layer", "X3DLayerNode"},
                        {"layoutNode", "X3DLayoutNode"},
                        {"viewport", "X3DViewportNode"},
                        {"metadataObject", "X3DMetadataObject"},
                        {"child", "X3DChildNode"},
                        {"bounded", "X3DBoundedObject"},
                        {"grouping", "X3DGroupingNode"},
                        {"bindable", "X3DBindableNode"},
                        {"viewpoint", "X3DViewpointNode"},
                        {"background", "X3DBackgroundNode"},
                        {"light", "X3DLightNode"},
                        {"collidable", "X3DNBodyCollidableNode"},
                        {"sensor", "X3DSensorNode"},
                        {"pointingSensor", "X3DPointingDeviceSensorNode"},
                        {"dragSensor", "X3DDragSensorNode"},
                        {"regionSensor", "X3DEnvironmentalSensorNode"},
                        {"interpolator", "X3DInterpolatorNode"},
                        {"trigger", "X3DTriggerNode"},
                        {"sequencer", "X3DSequencerNode"},
                        {"follower", "X3DFollowerNode"},
                        {"chaser", "X3DChaserNode"},
                        {"damper", "X3DDamperNode"}};

} // namespace

std::string_view abstractTypeOfRole(std::string_view role) {
  const auto found = std::find_if(std::begin(rows), std::end(rows),
                                  [&](const Row& row) { return row.role == role; });
  return found == std::end(rows) ? std::string_view() : found->type;
}

MFString abstractTypesOf(const NodeType& type) {
  MFString types{"X3DNode"};
  if (type.index == ProtoInstance::typeIndex) types.push_back("X3DPrototypeInstance");
  for (const Row& row : rows)
    if (type.is(row.role)) types.emplace_back(row.type);
  if (type.index == ScriptNode::typeIndex || type.name == "Script")
    types.push_back("X3DScriptNode");
  if (type.name == "Shape" || type.name == "ParticleSystem") types.push_back("X3DShapeNode");
  if (type.name == "TouchSensor") types.push_back("X3DTouchSensorNode");
  return types;
}

} // namespace xvrml
