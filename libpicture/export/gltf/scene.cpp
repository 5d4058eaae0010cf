#include "libpicture/export/gltf/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace picture::gltf {

using xvrml::Node;
using xvrml::nodeCast;
using xvrml::Vec3f;
namespace nodes = xvrml::nodes;

namespace {

Vec vecOf(const Vec3f& v) { return {v.x, v.y, v.z}; }

Vec transformed(const double m[16], const Vec& p) {
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
          m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

bool isFinite(const Vec& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Returns how much longer a matrix makes things, as a mean of all directions.
double scaleOf(const double m[16]) {
  const double volume =
      std::abs(m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
               m[8] * (m[1] * m[6] - m[2] * m[5]));
  return volume > 0 && std::isfinite(volume) ? std::cbrt(volume) : 1;
}

// Returns whether a matrix makes things longer alike in all directions.
bool isEven(const double m[16]) {
  constexpr double same = 1e-5; // matrices of many floats are no better
  const double square = scaleOf(m) * scaleOf(m);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k <= i; ++k) {
      const double product =
          m[4 * i] * m[4 * k] + m[4 * i + 1] * m[4 * k + 1] + m[4 * i + 2] * m[4 * k + 2];
      if (!(std::abs(product - (i == k ? square : 0)) <= same * square)) return false;
    }
  return true;
}

float positive(float v, float most) { return v > 0 ? std::min(v, most) : 0; } // NaN: 0

// Returns a number in its range; one that is none becomes the lower end.
double clamped(double v, double low, double high) { return v > low ? std::min(v, high) : low; }

constexpr float largest = 1e30f; // upper limit for intensities and distances

// Nodes that say something about the whole world or about other nodes, and draw nothing.
bool isSilent(const Node& node) {
  return node.type().is("metadataObject") || nodeCast<nodes::WorldInfo>(&node) ||
         nodeCast<nodes::NavigationInfo>(&node);
}

bool isGroup(const Node& node) {
  return node.type().is("grouping") || nodeCast<xvrml::ProtoInstance>(&node) || node.type().expand;
}

} // namespace

double candelaOf(double irradiance, const Vec3f& attenuation, double distance, double scale) {
  const double a = attenuation.x, b = attenuation.y, c = attenuation.z;
  const double inside = distance / scale; // in the coordinates of the node
  const double divisor = std::max(a + b * inside + c * inside * inside, 1.0);
  return irradiance * distance * distance / divisor;
}

Scene::Scene(Document& document, Meshes& meshes, Motions& motions, Remarks& remarks)
    : document_(document), meshes_(meshes), motions_(motions), remarks_(remarks) {
  std::fill(low_, low_ + 3, std::numeric_limits<double>::infinity());
  std::fill(high_, high_ + 3, -std::numeric_limits<double>::infinity());
}

void Scene::enter(const Node& node, const State& state, std::vector<Json> chain) {
  Open open;
  open.depth = state.path.size();
  open.node = &node;
  open.chain = std::move(chain);
  if (!node.defName.empty()) open.chain.front()["name"] = node.defName;
  open_.push_back(std::move(open));
}

Scene::Visit Scene::render(Node& node, const State& state) {
  if (isGroup(node)) {
    if (!node.defName.empty()) enter(node, state, {Json::object()});
    return Visit::children;
  }
  if (!isSilent(node) && !motions_.uses(node)) remarks_.leaveOut(node.type().name);
  return Visit::skip;
}

template <class T> Scene::Visit Scene::open(T& node, const State& state) {
  const bool moves = motions_.moves(node);
  const Places places = placesOf(
      {node.center, node.translation, node.scale, node.rotation, node.scaleOrientation}, moves);
  std::vector<Json> chain;
  for (const Place& place : places.chain) {
    chain.push_back(Json::object());
    setPlace(chain.back(), place);
  }
  enter(node, state, std::move(chain));
  open_.back().scaleAt = places.scaleAt;
  open_.back().offset = vecOf(node.center);
  return Visit::children;
}

Scene::Visit Scene::renderTransform(nodes::Transform& node, const State& state) {
  return open(node, state);
}

Scene::Visit Scene::renderCADPart(nodes::CADPart& node, const State& state) {
  return open(node, state);
}

Scene::Visit Scene::renderBillboard(nodes::Billboard& node, const State& state) {
  remarks_.change("a Billboard does not turn");
  Place place;
  place.rotation = quaternionOf(state.local);
  Json object = Json::object();
  setPlace(object, place);
  enter(node, state, {std::move(object)});
  return Visit::children;
}

Scene::Visit Scene::renderLOD(nodes::LOD& node, const State& state) {
  if (node.level.size() > 1) remarks_.change("an LOD has its finest level alone");
  return render(node, state);
}

Scene::Visit Scene::renderSwitch(nodes::Switch& node, const State& state) {
  const bool shows = node.choice.size() == 1 && node.whichChoice == 0;
  const bool none = node.whichChoice < 0 || size_t(node.whichChoice) >= node.choice.size();
  if (!shows && !node.choice.empty() && (none || !choosesLooks(node)))
    remarks_.change("a Switch has its present choice");
  return render(node, state);
}

Scene::Visit Scene::renderAnchor(nodes::Anchor& node, const State& state) {
  remarks_.change("an Anchor is no link");
  return render(node, state);
}

Scene::Visit Scene::renderShape(nodes::Shape&, const State&) { return Visit::draw; }

// Returns whether a Switch chooses between looks of one geometry.
bool Scene::choosesLooks(const nodes::Switch& node) {
  const auto [found, fresh] = choosers_.try_emplace(&node);
  if (fresh) found->second = !looksOf(node).empty();
  return found->second;
}

// Returns the Switch that chooses a Shape for its look; null if there is none.
const nodes::Switch* Scene::chooserOf(const State& state) {
  size_t above = state.path.size() - 1;
  while (above > 0 && nodeCast<xvrml::ProtoInstance>(state.path[above - 1])) --above;
  const auto* chooser = above > 0 ? nodeCast<nodes::Switch>(state.path[above - 1]) : nullptr;
  return chooser && choosesLooks(*chooser) ? chooser : nullptr;
}

void Scene::draw(const xvrml::DrawnShape& shape) {
  const std::optional<MeshUse> use = meshes_.use(shape, chooserOf(shape.state));
  if (!use) return;
  grow(use->box, shape.matrix());
  const xvrml::AppearanceParts& look = shape.appearance();
  const bool physical = !look.shader && xvrml::takesIrradiance(look.material);
  hasPhysical_ |= physical;
  hasOthers_ |= !physical &&
                (look.shader || (look.material && !nodeCast<nodes::UnlitMaterial>(look.material)));
  if (!open_.empty()) {
    open_.back().shapes.push_back({use->mesh, shape.shape.defName});
    return;
  }
  Json node = {{"mesh", use->mesh}};
  if (!shape.shape.defName.empty()) node["name"] = shape.shape.defName;
  addChild(document_.add("nodes", node));
}

void Scene::leave(Node& node, const State& state) {
  if (open_.empty() || open_.back().node != &node || open_.back().depth != state.path.size())
    return;
  close();
}

// A single shape needs no node of its own, unless both have a name.
void Scene::addShapes(Open& open, Json& innermost) {
  if (open.shapes.size() == 1) {
    const Open::Drawn& only = open.shapes[0];
    if (only.name.empty() || !innermost.contains("name")) {
      innermost["mesh"] = only.mesh;
      if (!only.name.empty()) innermost["name"] = only.name;
      return;
    }
  }
  for (const Open::Drawn& shape : open.shapes) {
    Json node = {{"mesh", shape.mesh}};
    if (!shape.name.empty()) node["name"] = shape.name;
    open.children.push_back(document_.add("nodes", node));
  }
}

// Writes the open node after its children, so that their indices are known.
void Scene::close() {
  Open open = std::move(open_.back());
  open_.pop_back();
  Json& innermost = open.chain.back();
  addShapes(open, innermost);
  const bool moves = motions_.moves(*open.node);
  const bool empty = open.children.empty() && !innermost.contains("mesh");
  if (empty && !moves && !open.chain.front().contains("name")) return;
  if (!open.children.empty()) innermost["children"] = open.children;
  size_t below = 0, scaleNode = 0;
  for (size_t i = open.chain.size(); i-- > 0;) {
    if (i + 1 < open.chain.size()) open.chain[i]["children"] = Json::array({below});
    below = document_.add("nodes", open.chain[i]);
    if (i == open.scaleAt) scaleNode = below;
  }
  if (moves) motions_.place(*open.node, {below, scaleNode, open.offset});
  addChild(below);
}

void Scene::addChild(size_t node) {
  if (open_.empty())
    document_.addRoot(node);
  else
    open_.back().children.push_back(node);
}

void Scene::addPlaced(Json node, const Place& place, const Node& of) {
  setPlace(node, place);
  if (!of.defName.empty()) node["name"] = of.defName;
  addChild(document_.add("nodes", node));
}

Scene::Visit Scene::renderViewpoint(nodes::Viewpoint& node, const State& state) {
  constexpr float narrowest = 1e-3f, widest = 3.1f;
  const float angle = std::clamp(positive(node.fieldOfView, widest), narrowest, widest);
  addCamera({{"type", "perspective"}, {"perspective", {{"yfov", angle}}}}, node.description,
            node.position, node.orientation, node, state);
  return Visit::skip;
}

Scene::Visit Scene::renderOrthoViewpoint(nodes::OrthoViewpoint& node, const State& state) {
  float edges[4] = {-1, -1, 1, 1}; // left, bottom, right, top
  const auto& given = node.fieldOfView;
  if (given.size() >= 4 && given[0] < given[2] && given[1] < given[3] &&
      std::all_of(given.begin(), given.begin() + 4, [](float x) { return std::abs(x) < largest; }))
    std::copy_n(given.begin(), 4, edges);
  const float width = 0.5f * (edges[2] - edges[0]), height = 0.5f * (edges[3] - edges[1]);
  const Vec shift = rotated(quaternionOf(node.orientation),
                            {edges[0] + double(width), edges[1] + double(height), 0});
  const Vec3f position{node.position.x + float(shift.x), node.position.y + float(shift.y),
                       node.position.z + float(shift.z)};
  addCamera({{"type", "orthographic"}, {"orthographic", {{"xmag", width}, {"ymag", height}}}},
            node.description, position, node.orientation, node, state);
  return Visit::skip;
}

void Scene::addCamera(Json camera, const std::string& name, const Vec3f& position,
                      const xvrml::Rotation& orientation, const Node& node, const State& state) {
  if (!name.empty()) camera["name"] = name;
  Place place;
  if (isFinite(vecOf(position))) place.translation = vecOf(position);
  place.rotation = quaternionOf(orientation);
  addPlaced({{"camera", cameras_.size()}}, place, node);
  cameras_.push_back({std::move(camera),
                      transformed(state.matrix, place.translation),
                      scaleOf(state.matrix),
                      0,
                      {}});
}

template <class T>
Scene::Deferred Scene::lightOf(const T& node, const char* type, const State& state) {
  const xvrml::Color color = linearOf(node.color);
  Deferred light{{{"type", type}, {"color", {color.r, color.g, color.b}}},
                 {},
                 scaleOf(state.matrix),
                 double(positive(node.intensity, largest)),
                 {}};
  if (!node.defName.empty()) light.object["name"] = node.defName;
  if (node.ambientIntensity > 0) remarks_.change("the ambient part of a light is left out");
  return light;
}

void Scene::addLight(Deferred light, const Place& place, const Node& node) {
  addPlaced({{"extensions", {{"KHR_lights_punctual", {{"light", lights_.size()}}}}}}, place, node);
  lights_.push_back(std::move(light));
}

// A light that is off may be turned on in the world; glTF has no such light.
bool Scene::isOff(bool on) {
  if (!on) remarks_.change("a light that is off is left out");
  return !on;
}

Scene::Visit Scene::renderDirectionalLight(nodes::DirectionalLight& node, const State& state) {
  if (isOff(node.on)) return Visit::skip;
  if (!node.global && state.path.size() > 1)
    remarks_.change("a DirectionalLight of a group shines on everything");
  Deferred light = lightOf(node, "directional", state);
  Place place;
  place.rotation = quaternionToward(node.direction);
  addLight(std::move(light), place, node);
  return Visit::skip;
}

// Sets what lights with a place have. Returns the place of the glTF node.
template <class T> Place Scene::placeLight(const T& node, const State& state, Deferred& light) {
  Place place;
  light.placed = true;
  if (isFinite(vecOf(node.location))) place.translation = vecOf(node.location);
  light.place = transformed(state.matrix, place.translation);
  light.attenuation = {positive(node.attenuation.x, largest), positive(node.attenuation.y, largest),
                       positive(node.attenuation.z, largest)};
  if (!isEven(state.matrix))
    remarks_.change(
        "a light falls off alike in all directions, though an uneven scale is above it");
  constexpr double endless = 0.999e9; // readers of glTF say 1e9, as a float
  const double range = double(positive(node.radius, largest)) * light.scale;
  if (range > 0 && range < endless) light.object["range"] = float(range);
  return place;
}

Scene::Visit Scene::renderPointLight(nodes::PointLight& node, const State& state) {
  if (isOff(node.on)) return Visit::skip;
  Deferred light = lightOf(node, "point", state);
  const Place place = placeLight(node, state, light);
  addLight(std::move(light), place, node);
  return Visit::skip;
}

Scene::Visit Scene::renderSpotLight(nodes::SpotLight& node, const State& state) {
  if (isOff(node.on)) return Visit::skip;
  Deferred light = lightOf(node, "spot", state);
  Place place = placeLight(node, state, light);
  place.rotation = quaternionToward(node.direction);
  constexpr float narrowest = 1e-3f, widest = float(std::numbers::pi / 2);
  const float outer = std::clamp(positive(node.cutOffAngle, widest), narrowest, widest);
  // The inner angle must be smaller (KHR_lights_punctual).
  const float inner = std::min(positive(node.beamWidth, widest), 0.999f * outer);
  light.object["spot"] = {{"innerConeAngle", inner}, {"outerConeAngle", outer}};
  addLight(std::move(light), place, node);
  return Visit::skip;
}

void Scene::grow(const Box& box, const double matrix[16]) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec p = transformed(matrix, {corner & 1 ? box.high.x : box.low.x,
                                       corner & 2 ? box.high.y : box.low.y,
                                       corner & 4 ? box.high.z : box.low.z});
    if (!isFinite(p)) continue;
    const double numbers[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
      low_[i] = std::min(low_[i], numbers[i]);
      high_[i] = std::max(high_[i], numbers[i]);
    }
  }
}

Vec Scene::centre() const {
  if (low_[0] > high_[0]) return {};
  return {0.5 * (low_[0] + high_[0]), 0.5 * (low_[1] + high_[1]), 0.5 * (low_[2] + high_[2])};
}

// The planes between which things are drawn: VRML97 has none. The near one is a hundredth of the
// distance to the middle of the world, at most 10 cm.
void Scene::finishCamera(Deferred& camera) {
  const double radius =
      low_[0] > high_[0]
          ? 0
          : 0.5 * std::hypot(high_[0] - low_[0], high_[1] - low_[1], high_[2] - low_[2]);
  const double distance = length(centre() + camera.place * -1.0);
  if (!camera.object.contains("orthographic")) {
    camera.object["perspective"]["znear"] = float(clamped(0.01 * distance, 1e-5, 0.1));
    return;
  }
  Json& numbers = camera.object["orthographic"];
  numbers["znear"] = 0;
  numbers["zfar"] = float(clamped(2 * (distance + radius), 1, largest));
}

// Returns the irradiance that a light of intensity 1 has at surfaces which face it. glTF's surfaces
// reflect 1/pi of it, as PhysicalMaterial does (ISO/IEC 19775-1:2023 17.2.2), and Material all.
double Scene::irradianceOfOne() {
  if (hasPhysical_ && hasOthers_ && !lights_.empty())
    remarks_.change("lights are as bright as on Material, and pi times as bright as in the world "
                    "on PhysicalMaterial");
  return hasPhysical_ && !hasOthers_ ? 1 : std::numbers::pi;
}

// Sets the lux of a parallel light, or the candela of one with a place.
void Scene::finishLight(Deferred& light, double irradiance) {
  double strength = irradiance * light.intensity;
  if (light.placed) {
    const Vec3f& falloff = light.attenuation;
    const double distance = std::max(length(centre() + light.place * -1.0), 1e-3 * light.scale),
                 inside = distance / light.scale;
    strength = candelaOf(strength, falloff, distance, light.scale);
    // From here on the light falls off with the square in the world, too.
    const bool square =
        falloff.x == 0 && falloff.y == 0 && double(falloff.z) * inside * inside >= 1;
    if (!square)
      remarks_.change("a light falls off with the square of the distance, and is as bright as in "
                      "the world at the middle of what is drawn");
  }
  light.object["intensity"] = float(clamped(strength, 0, largest));
}

void Scene::finish() {
  Json list = Json::array();
  const double irradiance = irradianceOfOne();
  for (Deferred& light : lights_) {
    finishLight(light, irradiance);
    list.push_back(std::move(light.object));
  }
  if (!list.empty()) document_.addExtension("KHR_lights_punctual", {{"lights", std::move(list)}});
  for (Deferred& camera : cameras_) {
    finishCamera(camera);
    document_.add("cameras", camera.object);
  }
}

} // namespace picture::gltf
