// constants.cpp: Makes the object X3DConstants (ISO/IEC 19777-1) when a program first uses it, so
// that it takes no memory elsewhere. The standard leaves the numbers to the browser.
#include <cstring>
#include <iterator>

#include "slots.h"

namespace ecma {
namespace {

// Abstract types of ISO/IEC 19775-1:2023, whose numbers are their places here, from 1.
constexpr const char* nodeTypes[] = {"X3DNode",
                                     "X3DPrototypeInstance",
                                     "X3DAppearanceChildNode",
                                     "X3DAppearanceNode",
                                     "X3DBackgroundNode",
                                     "X3DBindableNode",
                                     "X3DBoundedObject",
                                     "X3DChaserNode",
                                     "X3DChildNode",
                                     "X3DColorNode",
                                     "X3DComposableVolumeRenderStyleNode",
                                     "X3DComposedGeometryNode",
                                     "X3DCoordinateNode",
                                     "X3DDamperNode",
                                     "X3DDragSensorNode",
                                     "X3DEnvironmentTextureNode",
                                     "X3DEnvironmentalSensorNode",
                                     "X3DFogObject",
                                     "X3DFollowerNode",
                                     "X3DFontStyleNode",
                                     "X3DGeometricPropertyNode",
                                     "X3DGeometryNode",
                                     "X3DGroupingNode",
                                     "X3DInfoNode",
                                     "X3DInterpolatorNode",
                                     "X3DKeyDeviceSensorNode",
                                     "X3DLayerNode",
                                     "X3DLayoutNode",
                                     "X3DLightNode",
                                     "X3DMaterialNode",
                                     "X3DMetadataObject",
                                     "X3DNBodyCollidableNode",
                                     "X3DNBodyCollisionSpaceNode",
                                     "X3DNetworkSensorNode",
                                     "X3DNormalNode",
                                     "X3DNurbsControlCurveNode",
                                     "X3DNurbsSurfaceGeometryNode",
                                     "X3DOneSidedMaterialNode",
                                     "X3DParametricGeometryNode",
                                     "X3DParticleEmitterNode",
                                     "X3DParticlePhysicsModelNode",
                                     "X3DPickSensorNode",
                                     "X3DPickableObject",
                                     "X3DPointingDeviceSensorNode",
                                     "X3DProductStructureChildNode",
                                     "X3DRigidJointNode",
                                     "X3DScriptNode",
                                     "X3DSensorNode",
                                     "X3DSequencerNode",
                                     "X3DShaderNode",
                                     "X3DShapeNode",
                                     "X3DSingleTextureCoordinateNode",
                                     "X3DSingleTextureNode",
                                     "X3DSingleTextureTransformNode",
                                     "X3DSoundChannelNode",
                                     "X3DSoundDestinationNode",
                                     "X3DSoundNode",
                                     "X3DSoundProcessingNode",
                                     "X3DSoundSourceNode",
                                     "X3DTexture2DNode",
                                     "X3DTexture3DNode",
                                     "X3DTextureCoordinateNode",
                                     "X3DTextureNode",
                                     "X3DTextureTransformNode",
                                     "X3DTimeDependentNode",
                                     "X3DTouchSensorNode",
                                     "X3DTriggerNode",
                                     "X3DUrlObject",
                                     "X3DVertexAttributeNode",
                                     "X3DViewpointNode",
                                     "X3DViewportNode",
                                     "X3DVolumeDataNode",
                                     "X3DVolumeRenderStyleNode"};

// Events of a browser (ISO/IEC 19775-2 7.3).
constexpr const char* browserEvents[] = {"INITIALIZED_EVENT", "SHUTDOWN_EVENT", "CONNECTION_ERROR"};

struct Access {
  const char* name;
  XsAccess access;
  int number;
};
constexpr Access accesses[] = {{"initializeOnly", XS_FIELD, 1},
                               {"inputOnly", XS_EVENT_IN, 2},
                               {"outputOnly", XS_EVENT_OUT, 4},
                               {"inputOutput", XS_EXPOSED_FIELD, 7}};

void putNumber(duk_context* ctx, const char* name, int number) {
  duk_push_string(ctx, name);
  duk_push_int(ctx, number);
  duk_def_prop(ctx, -3, DUK_DEFPROP_HAVE_VALUE | DUK_DEFPROP_SET_ENUMERABLE);
}

void pushConstants(duk_context* ctx) {
  duk_push_object(ctx);
  for (int i = 0; i < int(std::size(browserEvents)); ++i) putNumber(ctx, browserEvents[i], i);
  for (const Access& one : accesses) putNumber(ctx, one.name, one.number);
  for (int i = XS_SFBOOL; i <= XS_LAST_TYPE; ++i) putNumber(ctx, typeName(XsType(i)), i);
  for (const char* name : nodeTypes) putNumber(ctx, name, nodeTypeNumber(name));
}

// Replaces the accessor by the object.
duk_ret_t getConstants(duk_context* ctx) {
  step(Interpreter::of(ctx));
  duk_push_global_object(ctx);
  duk_push_string(ctx, "X3DConstants");
  pushConstants(ctx);
  duk_dup(ctx, -1);
  duk_insert(ctx, -4); // stack: object, global, name, object
  duk_def_prop(ctx, -3, DUK_DEFPROP_HAVE_VALUE | DUK_DEFPROP_HAVE_WRITABLE | DUK_DEFPROP_FORCE);
  duk_pop(ctx);
  return 1;
}
duk_ret_t keepConstants(duk_context*) { return 0; }

} // namespace

int nodeTypeNumber(const char* name) {
  for (size_t i = 0; i < std::size(nodeTypes); ++i)
    if (std::strcmp(nodeTypes[i], name) == 0) return int(i) + 1;
  return 0;
}

int accessNumber(XsAccess access) {
  for (const Access& one : accesses)
    if (one.access == access) return one.number;
  return 0;
}

void registerConstants(duk_context* ctx) {
  duk_push_global_object(ctx);
  putAccessor(ctx, "X3DConstants", getConstants, keepConstants, 0);
  duk_pop(ctx);
}

} // namespace ecma
