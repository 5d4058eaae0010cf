#include "parse/x3d.h"

#include <algorithm>
#include <iterator>

namespace xvrml {
namespace {

constexpr std::string_view nodes[] = {"Arc2D",
                                      "ArcClose2D",
                                      "BooleanFilter",
                                      "BooleanSequencer",
                                      "BooleanToggle",
                                      "BooleanTrigger",
                                      "Circle2D",
                                      "ClipPlane",
                                      "ColorRGBA",
                                      "ComposedShader",
                                      "Disk2D",
                                      "FillProperties",
                                      "IndexedTriangleFanSet",
                                      "IndexedTriangleSet",
                                      "IndexedTriangleStripSet",
                                      "IntegerSequencer",
                                      "IntegerTrigger",
                                      "KeySensor",
                                      "LineProperties",
                                      "LineSet",
                                      "LoadSensor",
                                      "MetadataBoolean",
                                      "MetadataDouble",
                                      "MetadataFloat",
                                      "MetadataInteger",
                                      "MetadataSet",
                                      "MetadataString",
                                      "MultiTexture",
                                      "MultiTextureCoordinate",
                                      "MultiTextureTransform",
                                      "OrthoViewpoint",
                                      "PhysicalMaterial",
                                      "Polyline2D",
                                      "Polypoint2D",
                                      "PositionInterpolator2D",
                                      "QuadSet",
                                      "Rectangle2D",
                                      "StaticGroup",
                                      "StringSensor",
                                      "TextureProperties",
                                      "TimeTrigger",
                                      "TriangleFanSet",
                                      "TriangleSet",
                                      "TriangleSet2D",
                                      "TriangleStripSet",
                                      "TwoSidedMaterial",
                                      "UnlitMaterial",
                                      "Viewport"};

struct Field {
  std::string_view type, field;
};
constexpr Field fields[] = {{"Appearance", "fillProperties"},
                            {"Appearance", "lineProperties"},
                            {"Background", "transparency"},
                            {"Box", "solid"},
                            {"Cone", "solid"},
                            {"Cylinder", "solid"},
                            {"DirectionalLight", "global"},
                            {"ImageTexture", "textureProperties"},
                            {"Inline", "load"},
                            {"NavigationInfo", "transitionTime"},
                            {"NavigationInfo", "transitionType"},
                            {"PlaneSensor", "axisRotation"},
                            {"PointLight", "global"},
                            {"Sphere", "solid"},
                            {"SpotLight", "global"},
                            {"Text", "solid"},
                            {"TouchSensor", "description"},
                            {"Viewpoint", "centerOfRotation"}};

} // namespace

bool isX3dNode(std::string_view type) {
  return std::find(std::begin(nodes), std::end(nodes), type) != std::end(nodes);
}

bool isX3dField(std::string_view type, std::string_view field) {
  return field == "metadata" || // every node of X3D has it
         std::any_of(std::begin(fields), std::end(fields),
                     [&](const Field& one) { return one.type == type && one.field == field; });
}

} // namespace xvrml
