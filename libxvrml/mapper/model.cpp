#include "mapper/model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "lower_case.h"
#include "mapper/shading/appearance.h"
#include "xvrml/appearance.h"
#include "xvrml/comments.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {
namespace {

// Programs that write VRML and the up axis they use. They are recognised by words in the first
// comments of the file or in WorldInfo. The first matching word decides.
struct Exporter {
  std::string_view word;
  Axis up;
};
constexpr Exporter exporters[] = {
    {"kicad", Axis::z},       {"stepup", Axis::z},      {"pcbnew", Axis::z},
    {"freecad", Axis::z},     {"openscad", Axis::z},    {"cadquery", Axis::z},
    {"opencascade", Axis::z}, {"catia", Axis::z},       {"openhrp", Axis::z},
    {"choreonoid", Axis::z},  {"blender", Axis::y},     {"3d studio", Axis::y},
    {"cosmoworlds", Axis::y}, {"wings 3d", Axis::y},    {"titania", Axis::y},
    {"white_dune", Axis::y},  {"x3dtovrml97", Axis::y},
};

// Fraction of an extent: a bound this close to 0 is "on 0", a centre is "about 0".
constexpr double near = 0.02;
constexpr double plate = 0.35;  // fraction of the smaller other extent: thinner is a plate
constexpr double plane = 0.001; // fraction of the largest extent: thinner is a planar figure

const Exporter* exporterIn(std::string_view text) {
  const std::string low = lowerCase(text);
  for (const Exporter& one : exporters)
    if (low.find(one.word) != low.npos) return &one;
  return nullptr;
}

bool showsSkyOrGround(const nodes::Background& sky) {
  return !sky.groundColor.empty() || sky.skyColor.size() > 1 || !sky.backUrl.empty() ||
         !sky.frontUrl.empty();
}

// Returns whether the world has Joints of OpenHRP or Choreonoid: robots with z up. The Joint of
// H-Anim has no jointAxis field.
bool hasRobotJoints(const World& world) {
  for (const ProtoPtr& proto : world.scope.prototypes)
    if (proto && proto->type && proto->type->name == "Joint")
      for (const FieldInfo& field : proto->type->fields)
        if (field.name == "jointAxis") return true;
  return false;
}

// Returns evidence for y up: nodes that VRML itself orients along y, or geometry nodes that people
// write and exporters do not. Returns "" if there is none.
std::string evidenceForYUp(const World& world, const Graph& graph) {
  for (const NodeRef& root : world.scope.roots) {
    if (const auto* info = nodeCast<nodes::NavigationInfo>(root);
        info && !info->type.empty() && info->type.front() == "WALK")
      return "NavigationInfo has WALK as its first type";
    if (const auto* sky = nodeCast<nodes::Background>(root); sky && showsSkyOrGround(*sky))
      return "Background has a ground or a sky";
  }
  for (const ItemId id : graph.order) {
    const Item& item = graph.items[id];
    if (item.kind != Kind::shape) continue;
    const Node* geometry =
        renderedNode(static_cast<const nodes::Shape&>(*item.node).geometry.get());
    if (!geometry) continue;
    const int type = geometry->type().index;
    if (type != nodes::IndexedFaceSet::typeIndex && type != nodes::IndexedLineSet::typeIndex &&
        type != nodes::PointSet::typeIndex)
      return "it has a " + geometry->type().name + ", which exporters of models do not write";
  }
  return {};
}

// Guesses from the world's bounding box. It compares y and z; x is never up. isStl: z is up unless
// the model stands or lies on y = 0: parts that are printed or belong to robots have z up, and so
// do other programs that show STL files.
UpGuess fromBounds(const Bounds& b, bool isStl) {
  double extent[3], middle[3];
  for (int i = 0; i < 3; ++i) {
    extent[i] = b.maximum[i] - b.minimum[i];
    middle[i] = (b.maximum[i] + b.minimum[i]) / 2;
  }
  const double largest = std::max({extent[0], extent[1], extent[2]});
  if (extent[2] <= plane * largest && !isStl)
    return {Axis::y, "it is a figure in the x-y plane", true};
  if (extent[1] <= plane * largest) return {Axis::y, "it lies in the x-z plane"};
  const auto standsOn = [&](int i) { return std::abs(b.minimum[i]) <= near * extent[i]; };
  const auto liesAbout = [&](int i) { return std::abs(middle[i]) <= near * extent[i]; };
  const auto isPlate = [&](int i) {
    return extent[i] < plate * std::min(extent[(i + 1) % 3], extent[(i + 2) % 3]);
  };
  if (standsOn(2) != standsOn(1)) {
    if (standsOn(2)) return {Axis::z, "it stands on z = 0"};
    return {Axis::y, "it stands on y = 0"};
  }
  if (isStl) return {Axis::z, "it is an STL file"};
  if (isPlate(2)) return {Axis::z, "it is flat along z"};
  if (isPlate(1)) return {Axis::y, "it is flat along y"};
  if (liesAbout(0) && liesAbout(1) != liesAbout(2)) {
    if (liesAbout(1)) return {Axis::z, "x and y are centred about 0, z is not"};
    return {Axis::y, "x and z are centred about 0, y is not"};
  }
  return {Axis::y, "there is no sign of another axis"};
}

AppearanceParts appearanceOf(const Item& shape) {
  return resolveAppearance(static_cast<const nodes::Shape&>(*shape.node).appearance.get());
}

} // namespace

UpGuess guessUp(const World& world, const Graph& graph, const Bounds& bounds) {
  if (bounds.empty) return {Axis::y, "nothing is drawn"};
  if (world.head.version.encoding == Encoding::step) return {Axis::z, "it is a STEP model"};
  const UpGuess shape = fromBounds(bounds, world.head.version.encoding == Encoding::stl);
  const auto written = [&](const Exporter& one, const char* where) {
    return UpGuess{one.up, where + (" names " + std::string(one.word)),
                   one.up == Axis::y && shape.frontal};
  };
  if (const Exporter* one = exporterIn(openingComments(world)))
    return written(*one, "the file's comment");
  for (const NodeRef& root : world.scope.roots) {
    const auto* info = nodeCast<nodes::WorldInfo>(root);
    if (!info) continue;
    std::string text = info->title;
    for (const std::string& line : info->info) text += "\n" + line;
    if (const Exporter* one = exporterIn(text)) return written(*one, "WorldInfo");
  }
  if (hasRobotJoints(world)) return {Axis::z, "its prototype Joint has a jointAxis"};
  if (const std::string why = evidenceForYUp(world, graph); !why.empty())
    return {Axis::y, why, shape.frontal};
  return shape;
}

size_t countIfAllClear(const Graph& graph) {
  size_t shapes = 0;
  for (const ItemId id : graph.order) {
    const Item& item = graph.items[id];
    if (item.kind != Kind::shape) continue;
    const AppearanceParts parts = appearanceOf(item);
    // A picture may have an alpha of its own, but it cannot make anything opaque here.
    if (!parts.plain || !(materialValues(parts.material).transparency >= 1)) return 0;
    ++shapes;
  }
  return shapes;
}

bool hasUnspecifiedLighting(const Graph& graph, const Bound& bound) {
  if (bound.navigationInfo || nodeCast<nodes::ORTBackground>(bound.background)) return false;
  for (const ItemId id : graph.order) {
    const Item& item = graph.items[id];
    if (isLight(item.kind)) return false;
    if (item.kind != Kind::shape) continue;
    if (const AppearanceParts parts = appearanceOf(item); parts.appearance && !parts.plain)
      return false;
  }
  return true;
}

} // namespace xvrml::mapper

namespace xvrml {

namespace {
Vector towards(Axis axis) {
  Vector v(0);
  v[int(axis) % 3] = int(axis) < 3 ? 1 : -1;
  return v;
}
} // namespace

void upVector(Axis axis, double up[3]) {
  const Vector v = towards(axis);
  for (int i = 0; i < 3; ++i) up[i] = v[i];
}

// The front is the side from which x points right: +z for a model with y up, -y for one with z up.
// With x up the front is +z, as with y up.
void threeQuarterView(Axis axis, double view[16]) {
  constexpr double side = 35 * std::numbers::pi / 180, above = 25 * std::numbers::pi / 180;
  const Vector top = towards(axis);
  const Vector front = int(axis) % 3 == 2 ? Vector(0, int(axis) == 2 ? -1 : 1, 0) : Vector(0, 0, 1);
  const Vector aside = top.cross(front);
  const Vector back = front * (std::cos(side) * std::cos(above)) +
                      aside * (std::sin(side) * std::cos(above)) + top * std::sin(above);
  const Vector right = top.cross(back).normalized(), up = back.cross(right);
  const double columns[16] = {right.x, right.y, right.z, 0, up.x, up.y, up.z, 0,
                              back.x,  back.y,  back.z,  0, 0,    0,    0,    1};
  std::copy_n(columns, 16, view);
}

CameraSettings cameraAround(const BoundingSphere& sphere, const double view[16], double fovy,
                            double aspect) {
  constexpr double margin = 1.05;
  CameraSettings camera = mapper::cameraOf(nullptr, Matrix(), aspect);
  camera.fovy = fovy >= 0 && fovy < 3.14 ? fovy : camera.fovy;
  const double ratio = aspect > 0 ? aspect : 1, radius = sphere.radius > 0 ? sphere.radius : 1;
  if (sphere.empty) {
    if (camera.fovy == 0) camera.height = 10;
    return camera;
  }
  double distance = 2 * radius;
  if (camera.fovy == 0) {
    camera.height = 2 * margin * radius * std::max(1.0, 1 / ratio);
  } else {
    const double half = std::min(camera.fovy / 2, std::atan(std::tan(camera.fovy / 2) * ratio));
    distance = margin * radius / std::sin(half);
  }
  const Matrix axes = rotationOnly(fromArray(view));
  const Vector center(sphere.center[0], sphere.center[1], sphere.center[2]);
  toArray(compose(translation(center + transformDirection(axes, Vector(0, 0, distance))), axes),
          camera.matrix);
  return camera;
}

} // namespace xvrml
