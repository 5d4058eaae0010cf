#include "base/x3d.h"

#include <algorithm>
#include <iterator>

namespace xvrml {
namespace {

struct Field {
  std::string_view type, field;
};
constexpr Field fields[] = {{"Anchor", "autoRefresh"},
                            {"Anchor", "autoRefreshTimeLimit"},
                            {"Anchor", "load"},
                            {"Appearance", "acousticProperties"},
                            {"Appearance", "shaders"},
                            {"AudioClip", "autoRefresh"},
                            {"AudioClip", "autoRefreshTimeLimit"},
                            {"AudioClip", "bufferDuration"},
                            {"AudioClip", "enabled"},
                            {"AudioClip", "load"},
                            {"ComposedCubeMapTexture", "description"},
                            {"ElevationGrid", "attrib"},
                            {"Fog", "fogType_changed"},
                            {"GeneratedCubeMapTexture", "description"},
                            {"ImageCubeMapTexture", "autoRefresh"},
                            {"ImageCubeMapTexture", "autoRefreshTimeLimit"},
                            {"ImageCubeMapTexture", "description"},
                            {"ImageCubeMapTexture", "load"},
                            {"ImageTexture", "autoRefresh"},
                            {"ImageTexture", "autoRefreshTimeLimit"},
                            {"ImageTexture", "load"},
                            {"ImageTexture3D", "autoRefresh"},
                            {"ImageTexture3D", "autoRefreshTimeLimit"},
                            {"ImageTexture3D", "load"},
                            {"IndexedFaceSet", "attrib"},
                            {"IndexedLineSet", "attrib"},
                            {"IndexedLineSet", "normal"},
                            {"IndexedQuadSet", "attrib"},
                            {"IndexedTriangleFanSet", "attrib"},
                            {"IndexedTriangleSet", "attrib"},
                            {"IndexedTriangleStripSet", "attrib"},
                            {"LineSet", "attrib"},
                            {"LineSet", "normal"},
                            {"LoadSensor", "children"},
                            {"MovieTexture", "autoRefresh"},
                            {"MovieTexture", "autoRefreshTimeLimit"},
                            {"MovieTexture", "enabled"},
                            {"MovieTexture", "gain"},
                            {"MovieTexture", "load"},
                            {"MovieTexture", "pitch"},
                            {"MultiTexture", "description"},
                            {"PointSet", "attrib"},
                            {"PointSet", "normal"},
                            {"QuadSet", "attrib"},
                            {"Script", "autoRefresh"},
                            {"Script", "autoRefreshTimeLimit"},
                            {"Script", "load"},
                            {"Sound", "description"},
                            {"Sound", "enabled"},
                            {"TriangleFanSet", "attrib"},
                            {"TriangleSet", "attrib"},
                            {"TriangleStripSet", "attrib"}};

// Lists fields and events of ours that X3D calls otherwise (ISO/IEC 19775-1 10.4.4, 23.4.1, 23.4.3,
// :2023 34.4.1, 35.4.1, 40.4.5).
constexpr int neverWritten = 99;
struct Renamed {
  std::string_view type, x3d, own;
  int since = 3;             // the first major version of X3D in which the name is written
  int before = neverWritten; // the first one in which it no longer is
};
constexpr Renamed renamed[] = {
    {"Collision", "enabled", "collide"},
    {"Collision", "set_enabled", "set_collide"},
    {"Collision", "enabled_changed", "collide_changed"},
    {"ComposedCubeMapTexture", "backTexture", "back", neverWritten},
    {"ComposedCubeMapTexture", "bottomTexture", "bottom", neverWritten},
    {"ComposedCubeMapTexture", "frontTexture", "front", neverWritten},
    {"ComposedCubeMapTexture", "leftTexture", "left", neverWritten},
    {"ComposedCubeMapTexture", "rightTexture", "right", neverWritten},
    {"ComposedCubeMapTexture", "topTexture", "top", neverWritten},
    {"LOD", "children", "level"},
    {"LOD", "set_children", "set_level"},
    {"LOD", "children_changed", "level"}, // level_changed is another event in X3D
    {"LOD", "children_changed", "level_changed"},
    {"LOD", "level_changed", "activeLevel_changed"},
    {"Layer", "isPickable", "pickable", 3, 4},
    {"LayoutLayer", "isPickable", "pickable", 3, 4},
    {"LoadSensor", "children", "watchList", 4},
    {"LoadSensor", "set_children", "set_watchList", 4},
    {"LoadSensor", "children_changed", "watchList_changed", 4},
    {"ParticleSystem", "color", "colorRamp", 4},
    {"ParticleSystem", "texCoord", "texCoordRamp", 4},
    {"Switch", "children", "choice"},
    {"Switch", "set_children", "set_choice"},
    {"Switch", "children_changed", "choice_changed"},
};

} // namespace

std::string_view ownName(std::string_view type, std::string_view name) {
  for (const Renamed& one : renamed)
    if (one.type == type && one.x3d == name) return one.own;
  return name;
}

std::string_view x3dName(std::string_view type, std::string_view name, int version) {
  for (const Renamed& one : renamed)
    if (one.type == type && one.own == name && version >= one.since && version < one.before)
      return one.x3d;
  return name;
}

bool isAngleField(std::string_view type, std::string_view field) {
  constexpr std::string_view names[] = {"beamWidth", "creaseAngle", "cutOffAngle", "diskAngle",
                                        "endAngle",  "fieldOfView", "groundAngle", "maxAngle",
                                        "minAngle",  "skyAngle",    "startAngle"};
  if (field == "rotation") return type == "TextureTransform";
  if (field == "offset") return type == "CylinderSensor";
  if (field == "fieldOfView") return type != "OrthoViewpoint" && type != "TextureProjectorParallel";
  return std::find(std::begin(names), std::end(names), field) != std::end(names);
}

bool isGpuField(std::string_view field) { return field == "shaders" || field == "attrib"; }

bool isX3dField(std::string_view type, std::string_view field) {
  if (field.starts_with("set_")) field.remove_prefix(4);
  if (field.ends_with("_changed") && field != "level_changed" && field != "fogType_changed" &&
      field != "centerOfRotation_changed")
    field.remove_suffix(8);
  return std::any_of(std::begin(fields), std::end(fields),
                     [&](const Field& one) { return one.type == type && one.field == field; });
}

} // namespace xvrml
