// xvrml_x3d_nodes.cpp: the nodes of ISO/IEC 19775-1 (X3D) and the fields that it adds to those of
// VRML97, against lists typed from the standard.
#include <gtest/gtest.h>

#include <algorithm>

#include <xvrml/nodes.h>

namespace xvrml {
namespace {

// The clause, the node, and how many eventIns, exposedFields, fields and eventOuts its interface
// has.
struct Interface {
  const char* clause;
  const char* name;
  int eventIns, exposedFields, fields, eventOuts;
};
constexpr Interface interfaces[] = {
    {"7.4.1", "MetadataBoolean", 0, 3, 0, 0},
    {"7.4.2", "MetadataDouble", 0, 3, 0, 0},
    {"7.4.3", "MetadataFloat", 0, 3, 0, 0},
    {"7.4.4", "MetadataInteger", 0, 3, 0, 0},
    {"7.4.5", "MetadataSet", 0, 3, 0, 0},
    {"7.4.6", "MetadataString", 0, 3, 0, 0},
    {"9.4.3", "LoadSensor", 0, 3, 0, 4},
    {"10.4.2", "StaticGroup", 0, 2, 3, 0},
    {"11.4.1", "ClipPlane", 0, 2, 0, 0},
    {"11.4.3", "ColorRGBA", 0, 1, 0, 0},
    {"11.4.6", "IndexedTriangleFanSet", 1, 5, 5, 0},
    {"11.4.7", "IndexedTriangleSet", 1, 5, 5, 0},
    {"11.4.8", "IndexedTriangleStripSet", 1, 5, 5, 0},
    {"11.4.9", "LineSet", 0, 4, 0, 0},
    {"11.4.12", "TriangleFanSet", 0, 6, 4, 0},
    {"11.4.13", "TriangleSet", 0, 5, 4, 0},
    {"11.4.14", "TriangleStripSet", 0, 6, 4, 0},
    {"12.4.2", "FillProperties", 0, 4, 0, 0},
    {"12.4.3", "LineProperties", 0, 3, 0, 0},
    {"12.4.6", "PhysicalMaterial", 0, 17, 0, 0},
    {"12.4.6", "TwoSidedMaterial", 0, 13, 0, 0},
    {"12.4.7", "PointProperties", 0, 4, 0, 0},
    {"12.4.10", "UnlitMaterial", 0, 7, 0, 0},
    {"14.3.1", "Arc2D", 0, 0, 3, 0},
    {"14.3.2", "ArcClose2D", 0, 0, 5, 0},
    {"14.3.3", "Circle2D", 0, 0, 1, 0},
    {"14.3.4", "Disk2D", 0, 0, 3, 0},
    {"14.3.5", "Polyline2D", 0, 0, 1, 0},
    {"14.3.6", "Polypoint2D", 0, 1, 0, 0},
    {"14.3.7", "Rectangle2D", 0, 0, 2, 0},
    {"14.3.8", "TriangleSet2D", 0, 1, 1, 0},
    {"17.4.2", "EnvironmentLight", 0, 12, 0, 0},
    {"18.4.3", "MultiTexture", 0, 6, 0, 0},
    {"18.4.4", "MultiTextureCoordinate", 0, 1, 0, 0},
    {"18.4.5", "MultiTextureTransform", 0, 1, 0, 0},
    {"18.4.8", "TextureCoordinateGenerator", 0, 3, 0, 0},
    {"18.4.9", "TextureProperties", 0, 10, 1, 0},
    {"19.4.3", "CoordinateInterpolator2D", 1, 2, 0, 1},
    {"19.4.4", "EaseInEaseOut", 1, 2, 0, 1},
    {"19.4.8", "PositionInterpolator2D", 1, 2, 0, 1},
    {"19.4.10", "SplinePositionInterpolator", 1, 5, 0, 1},
    {"19.4.11", "SplinePositionInterpolator2D", 1, 5, 0, 1},
    {"19.4.12", "SplineScalarInterpolator", 1, 5, 0, 1},
    {"19.4.13", "SquadOrientationInterpolator", 1, 3, 0, 1},
    {"21.4.1", "KeySensor", 0, 1, 0, 8},
    {"21.4.2", "StringSensor", 0, 2, 0, 3},
    {"22.4.2", "TransformSensor", 0, 4, 0, 5},
    {"23.4.5", "OrthoViewpoint", 1, 11, 0, 2},
    {"23.4.7", "ViewpointGroup", 0, 6, 0, 0},
    {"24.4.3", "FogCoordinate", 0, 1, 0, 0},
    {"24.4.4", "LocalFog", 0, 4, 0, 0},
    {"24.4.5", "TextureBackground", 1, 11, 0, 2},
    {"25.3.2", "GeoElevationGrid", 1, 4, 13, 0},
    {"25.3.3", "GeoLocation", 2, 4, 4, 0},
    {"25.3.4", "GeoLOD", 0, 2, 12, 1},
    {"25.3.6", "GeoOrigin", 0, 1, 2, 0},
    {"25.3.10", "GeoTransform", 2, 8, 4, 0},
    {"25.3.11", "GeoViewpoint", 1, 11, 3, 2},
    {"26.3.1", "HAnimDisplacer", 0, 5, 0, 0},
    {"26.3.2", "HAnimHumanoid", 0, 28, 2, 0},
    {"26.3.3", "HAnimJoint", 2, 17, 2, 0},
    {"26.3.4", "HAnimMotion", 2, 14, 0, 3},
    {"26.3.4", "HAnimSegment", 2, 10, 2, 0},
    {"26.3.5", "HAnimSite", 2, 10, 2, 0},
    {"27.4.1", "Contour2D", 2, 1, 0, 0},
    {"27.4.2", "ContourPolyline2D", 0, 1, 0, 0},
    {"27.4.3", "CoordinateDouble", 0, 1, 0, 0},
    {"27.4.4", "NurbsCurve", 0, 3, 3, 0},
    {"27.4.5", "NurbsCurve2D", 0, 3, 3, 0},
    {"27.4.6", "NurbsOrientationInterpolator", 1, 4, 0, 1},
    {"27.4.7", "NurbsPatchSurface", 0, 5, 9, 0},
    {"27.4.8", "NurbsPositionInterpolator", 1, 4, 0, 1},
    {"27.4.9", "NurbsSet", 2, 4, 2, 0},
    {"27.4.10", "NurbsSurfaceInterpolator", 1, 2, 6, 2},
    {"27.4.11", "NurbsSweptSurface", 0, 2, 2, 0},
    {"27.4.12", "NurbsSwungSurface", 0, 2, 2, 0},
    {"27.4.13", "NurbsTextureCoordinate", 0, 2, 6, 0},
    {"27.4.14", "NurbsTrimmedSurface", 2, 6, 9, 0},
    {"28.3.3", "EspduTransform", 10, 61, 3, 19},
    {"30.4.1", "BooleanFilter", 1, 0, 0, 3},
    {"30.4.2", "BooleanSequencer", 3, 2, 0, 1},
    {"30.4.3", "BooleanToggle", 1, 1, 0, 0},
    {"30.4.4", "BooleanTrigger", 1, 0, 0, 1},
    {"30.4.5", "IntegerSequencer", 3, 2, 0, 1},
    {"30.4.6", "IntegerTrigger", 1, 1, 0, 1},
    {"30.4.7", "TimeTrigger", 1, 0, 0, 1},
    {"32.4.1", "CADAssembly", 2, 4, 2, 0},
    {"32.4.2", "CADFace", 0, 4, 2, 0},
    {"32.4.3", "CADLayer", 2, 4, 2, 0},
    {"32.4.4", "CADPart", 2, 9, 2, 0},
    {"32.4.5", "IndexedQuadSet", 1, 5, 5, 0},
    {"32.4.6", "QuadSet", 0, 5, 4, 0},
    {"33.4.1", "ComposedTexture3D", 0, 2, 4, 0},
    {"33.4.2", "ImageTexture3D", 0, 2, 4, 0},
    {"33.4.3", "PixelTexture3D", 0, 2, 4, 0},
    {"33.4.4", "TextureCoordinate3D", 0, 2, 0, 0},
    {"33.4.5", "TextureCoordinate4D", 0, 2, 0, 0},
    {"33.4.6", "TextureTransform3D", 0, 5, 0, 0},
    {"33.4.7", "TextureTransformMatrix3D", 0, 2, 0, 0},
    {"34.4.1", "ComposedCubeMapTexture", 0, 6, 0, 0},
    {"34.4.2", "GeneratedCubeMapTexture", 0, 1, 2, 0},
    {"34.4.3", "ImageCubeMapTexture", 0, 1, 1, 0},
    {"35.4.1", "Layer", 2, 5, 0, 0},
    {"35.4.2", "LayerSet", 0, 3, 0, 0},
    {"35.4.3", "Viewport", 2, 4, 2, 0},
    {"36.4.1", "Layout", 0, 6, 0, 0},
    {"36.4.2", "LayoutGroup", 2, 5, 2, 0},
    {"36.4.3", "LayoutLayer", 2, 6, 0, 0},
    {"36.4.5", "ScreenGroup", 2, 3, 2, 0},
    {"37.4.2", "CollidableOffset", 0, 5, 3, 0},
    {"37.4.3", "CollidableShape", 0, 5, 3, 0},
    {"37.4.4", "CollisionCollection", 0, 13, 2, 0},
    {"37.4.10", "RigidBody", 0, 25, 2, 0},
    {"37.4.11", "RigidBodyCollection", 1, 16, 3, 0},
    {"38.4.2", "PickableGroup", 2, 6, 2, 0},
    {"39.4.1", "ColorChaser", 2, 0, 3, 2},
    {"39.4.2", "ColorDamper", 2, 2, 3, 2},
    {"39.4.3", "CoordinateChaser", 2, 0, 3, 2},
    {"39.4.4", "CoordinateDamper", 2, 2, 3, 2},
    {"39.4.5", "OrientationChaser", 2, 0, 3, 2},
    {"39.4.6", "OrientationDamper", 2, 2, 3, 2},
    {"39.4.7", "PositionChaser", 2, 0, 3, 2},
    {"39.4.8", "PositionChaser2D", 2, 0, 3, 2},
    {"39.4.9", "PositionDamper", 2, 2, 3, 2},
    {"39.4.10", "PositionDamper2D", 2, 2, 3, 2},
    {"39.4.11", "ScalarChaser", 2, 0, 3, 2},
    {"39.4.12", "ScalarDamper", 2, 2, 3, 2},
    {"39.4.13", "TexCoordChaser2D", 2, 0, 3, 2},
    {"39.4.14", "TexCoordDamper2D", 2, 2, 3, 2},
    {"40.4.1", "BoundedPhysicsModel", 0, 2, 0, 0},
    {"40.4.2", "ConeEmitter", 0, 8, 0, 0},
    {"40.4.3", "ExplosionEmitter", 0, 6, 0, 0},
    {"40.4.4", "ForcePhysicsModel", 0, 2, 0, 0},
    {"40.4.5", "ParticleSystem", 0, 11, 9, 1},
    {"40.4.6", "PointEmitter", 0, 7, 0, 0},
    {"40.4.7", "PolylineEmitter", 0, 7, 1, 0},
    {"40.4.8", "SurfaceEmitter", 0, 5, 1, 0},
    {"40.4.9", "VolumeEmitter", 0, 7, 2, 0},
    {"40.4.10", "WindPhysicsModel", 0, 5, 0, 0},
};

// A field that X3D adds to a node of VRML97.
struct Addition {
  const char* node;
  const char* field;
  Access access;
  Value value;
};
const Addition additions[] = {
    {"Appearance", "alphaMode", Access::exposedField, SFString("AUTO")},
    {"Appearance", "alphaCutoff", Access::exposedField, 0.5f},
    {"Anchor", "bboxDisplay", Access::exposedField, false},
    {"Anchor", "visible", Access::exposedField, true},
    {"Billboard", "bboxDisplay", Access::exposedField, false},
    {"Billboard", "visible", Access::exposedField, true},
    {"Collision", "bboxDisplay", Access::exposedField, false},
    {"Collision", "visible", Access::exposedField, true},
    {"Collision", "isActive", Access::eventOut, {}},
    {"Group", "bboxDisplay", Access::exposedField, false},
    {"Group", "visible", Access::exposedField, true},
    {"Inline", "bboxDisplay", Access::exposedField, false},
    {"Inline", "visible", Access::exposedField, true},
    {"LOD", "bboxDisplay", Access::exposedField, false},
    {"LOD", "visible", Access::exposedField, true},
    {"Shape", "bboxDisplay", Access::exposedField, false},
    {"Shape", "visible", Access::exposedField, true},
    {"Switch", "bboxDisplay", Access::exposedField, false},
    {"Switch", "visible", Access::exposedField, true},
    {"Transform", "bboxDisplay", Access::exposedField, false},
    {"Transform", "visible", Access::exposedField, true},
    {"LOD", "bboxCenter", Access::field, Vec3f(0, 0, 0)},
    {"LOD", "bboxSize", Access::field, Vec3f(-1, -1, -1)},
    {"Shape", "bboxCenter", Access::field, Vec3f(0, 0, 0)},
    {"Shape", "bboxSize", Access::field, Vec3f(-1, -1, -1)},
    {"Switch", "bboxCenter", Access::field, Vec3f(0, 0, 0)},
    {"Switch", "bboxSize", Access::field, Vec3f(-1, -1, -1)},
    {"LOD", "addChildren", Access::eventIn, MFNode()},
    {"LOD", "removeChildren", Access::eventIn, MFNode()},
    {"Switch", "addChildren", Access::eventIn, MFNode()},
    {"Switch", "removeChildren", Access::eventIn, MFNode()},
    {"LOD", "forceTransitions", Access::field, false},
    {"NavigationInfo", "transitionComplete", Access::eventOut, {}},
    {"NavigationInfo", "transitionTime", Access::exposedField, SFTime(1)},
    {"NavigationInfo", "transitionType", Access::exposedField, MFString{"LINEAR"}},
    {"Viewpoint", "centerOfRotation", Access::exposedField, Vec3f(0, 0, 0)},
    {"Viewpoint", "retainUserOffsets", Access::exposedField, false},
    {"DirectionalLight", "global", Access::exposedField, false},
    {"DirectionalLight", "shadows", Access::exposedField, false},
    {"DirectionalLight", "shadowIntensity", Access::exposedField, 1.0f},
    {"PointLight", "global", Access::exposedField, true},
    {"PointLight", "shadows", Access::exposedField, false},
    {"PointLight", "shadowIntensity", Access::exposedField, 1.0f},
    {"SpotLight", "global", Access::exposedField, true},
    {"SpotLight", "shadows", Access::exposedField, false},
    {"SpotLight", "shadowIntensity", Access::exposedField, 1.0f},
    {"Background", "transparency", Access::exposedField, 0.0f},
    {"Inline", "global", Access::exposedField, false},
    {"Shape", "castShadow", Access::exposedField, true},
    {"ElevationGrid", "fogCoord", Access::exposedField, SFNode()},
    {"IndexedFaceSet", "fogCoord", Access::exposedField, SFNode()},
    {"IndexedLineSet", "fogCoord", Access::exposedField, SFNode()},
    {"PointSet", "fogCoord", Access::exposedField, SFNode()},
    {"Box", "solid", Access::field, true},
    {"Cone", "solid", Access::field, true},
    {"Cylinder", "solid", Access::field, true},
    {"Sphere", "solid", Access::field, true},
    {"Text", "solid", Access::field, false},
    {"Appearance", "backMaterial", Access::exposedField, SFNode()},
    {"Appearance", "fillProperties", Access::exposedField, SFNode()},
    {"Appearance", "lineProperties", Access::exposedField, SFNode()},
    {"Appearance", "pointProperties", Access::exposedField, SFNode()},
    {"ImageTexture", "description", Access::exposedField, SFString("")},
    {"ImageTexture", "textureProperties", Access::field, SFNode()},
    {"Material", "ambientTexture", Access::exposedField, SFNode()},
    {"Material", "ambientTextureMapping", Access::exposedField, SFString("")},
    {"Material", "diffuseTexture", Access::exposedField, SFNode()},
    {"Material", "diffuseTextureMapping", Access::exposedField, SFString("")},
    {"Material", "emissiveTexture", Access::exposedField, SFNode()},
    {"Material", "emissiveTextureMapping", Access::exposedField, SFString("")},
    {"Material", "normalTexture", Access::exposedField, SFNode()},
    {"Material", "normalTextureMapping", Access::exposedField, SFString("")},
    {"Material", "occlusionTexture", Access::exposedField, SFNode()},
    {"Material", "occlusionTextureMapping", Access::exposedField, SFString("")},
    {"Material", "shininessTexture", Access::exposedField, SFNode()},
    {"Material", "shininessTextureMapping", Access::exposedField, SFString("")},
    {"Material", "specularTexture", Access::exposedField, SFNode()},
    {"Material", "specularTextureMapping", Access::exposedField, SFString("")},
    {"Material", "normalScale", Access::exposedField, 1.0f},
    {"Material", "occlusionStrength", Access::exposedField, 1.0f},
    {"MovieTexture", "pauseTime", Access::exposedField, SFTime(0)},
    {"MovieTexture", "resumeTime", Access::exposedField, SFTime(0)},
    {"MovieTexture", "elapsedTime", Access::eventOut, SFTime(0)},
    {"MovieTexture", "isPaused", Access::eventOut, {}},
    {"MovieTexture", "description", Access::exposedField, SFString("")},
    {"MovieTexture", "textureProperties", Access::field, SFNode()},
    {"PixelTexture", "description", Access::exposedField, SFString("")},
    {"PixelTexture", "textureProperties", Access::field, SFNode()},
    {"TextureTransform", "mapping", Access::exposedField, SFString("")},
    {"Background", "bindTime", Access::eventOut, SFTime(0)},
    {"Fog", "bindTime", Access::eventOut, SFTime(0)},
    {"NavigationInfo", "bindTime", Access::eventOut, SFTime(0)},
    {"Viewpoint", "nearDistance", Access::exposedField, -1.0f},
    {"Viewpoint", "farDistance", Access::exposedField, -1.0f},
    {"Viewpoint", "viewAll", Access::exposedField, false},
    {"Viewpoint", "navigationInfo", Access::exposedField, SFNode()},
    {"Text", "lineBounds", Access::eventOut, MFVec2f()},
    {"Text", "origin", Access::eventOut, Vec3f(0, 0, 0)},
    {"Text", "textBounds", Access::eventOut, Vec2f(0, 0)},
    {"TextureCoordinate", "mapping", Access::exposedField, SFString("")},
    {"CylinderSensor", "axisRotation", Access::exposedField, Rotation(0, 1, 0, 0)},
    {"CylinderSensor", "description", Access::exposedField, SFString("")},
    {"CylinderSensor", "isOver", Access::eventOut, {}},
    {"PlaneSensor", "axisRotation", Access::exposedField, Rotation(0, 0, 1, 0)},
    {"PlaneSensor", "description", Access::exposedField, SFString("")},
    {"PlaneSensor", "isOver", Access::eventOut, {}},
    {"ProximitySensor", "centerOfRotation_changed", Access::eventOut, Vec3f(0, 0, 0)},
    {"SphereSensor", "description", Access::exposedField, SFString("")},
    {"SphereSensor", "isOver", Access::eventOut, {}},
    {"TimeSensor", "pauseTime", Access::exposedField, SFTime(0)},
    {"TimeSensor", "resumeTime", Access::exposedField, SFTime(0)},
    {"TimeSensor", "elapsedTime", Access::eventOut, SFTime(0)},
    {"TimeSensor", "isPaused", Access::eventOut, {}},
    {"TimeSensor", "description", Access::exposedField, SFString("")},
    {"TouchSensor", "description", Access::exposedField, SFString("")},
    {"AudioClip", "pauseTime", Access::exposedField, SFTime(0)},
    {"AudioClip", "resumeTime", Access::exposedField, SFTime(0)},
    {"AudioClip", "elapsedTime", Access::eventOut, SFTime(0)},
    {"AudioClip", "isPaused", Access::eventOut, {}},
    {"AudioClip", "gain", Access::exposedField, 1.0f},
    {"Inline", "load", Access::exposedField, true},
    {"Inline", "description", Access::exposedField, SFString("")},
    {"Inline", "autoRefresh", Access::exposedField, SFTime(0)},
    {"Inline", "autoRefreshTimeLimit", Access::exposedField, SFTime(3600)},
    {"LOD", "activeLevel_changed", Access::eventOut, 0},
};

int count(const NodeType& type, Access access) {
  return int(std::count_if(type.fields.begin(), type.fields.end(), [&](const FieldInfo& field) {
    return field.access == access && field.name != "metadata";
  }));
}

TEST(X3dNodes, InterfacesAreThoseOfTheStandard) {
  EXPECT_EQ(std::count_if(nodeTypes().begin(), nodeTypes().end(),
                          [](const NodeType* type) { return type->standard == Standard::x3d; }),
            std::ssize(interfaces));
  for (const Interface& expected : interfaces) {
    SCOPED_TRACE(expected.name);
    const NodeType* type = findNodeType(expected.name);
    ASSERT_NE(type, nullptr);
    EXPECT_EQ(type->standard, Standard::x3d);
    EXPECT_EQ(type->clause, expected.clause);
    EXPECT_EQ(count(*type, Access::eventIn), expected.eventIns);
    EXPECT_EQ(count(*type, Access::exposedField), expected.exposedFields);
    EXPECT_EQ(count(*type, Access::field), expected.fields);
    EXPECT_EQ(count(*type, Access::eventOut), expected.eventOuts);
    for (const FieldInfo& field : type->fields) EXPECT_FALSE(field.ofX3d) << field.name;
  }
}

TEST(X3dNodes, FieldsAreAddedToNodesOfVrml97) {
  std::ptrdiff_t marked = 0;
  for (const NodeType* type : nodeTypes())
    marked += std::count_if(type->fields.begin(), type->fields.end(), [](const FieldInfo& field) {
      return field.ofX3d && field.name != "metadata";
    });
  EXPECT_EQ(marked, std::ssize(additions));
  for (const Addition& expected : additions) {
    SCOPED_TRACE(std::string(expected.node) + '.' + expected.field);
    const NodeType* type = findNodeType(expected.node);
    ASSERT_NE(type, nullptr);
    const FieldInfo* field = type->find(expected.field);
    ASSERT_NE(field, nullptr);
    EXPECT_TRUE(field->ofX3d);
    EXPECT_EQ(field->access, expected.access);
    EXPECT_EQ(field->defaultValue, expected.value);
  }
}

} // namespace
} // namespace xvrml
