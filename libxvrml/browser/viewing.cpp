// viewing.cpp: the Browser's functions for the viewer: binding, camera, rays, pointer, navigation,
// Inlines.
#include <cmath>

#include "behaviour/inline.h"
#include "behaviour/viewer/interaction.h"
#include "browser/state.h"
#include "event/hierarchy.h"
#include "nodes/viewpoint.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

PickRay rayOf(const double origin[3], const double direction[3]) {
  return {{origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]}};
}

} // namespace

BoundNodes Browser::bound() const { return interactionOf(*impl_->engine).binding.bound(); }

CameraSettings Browser::camera(double aspect) const {
  return interactionOf(*impl_->engine).viewer.camera(aspect);
}

void Browser::placeViewer(const double view[16]) {
  Engine& engine = *impl_->engine;
  if (engine.settling()) return;
  engine.beginCascade(engine.now());
  interactionOf(engine).viewer.moveTo(fromArray(view));
  interactionOf(engine).navigation.resetMotion();
  engine.settle();
  impl_->runJobs();
}

void Browser::setUp(const double up[3]) {
  const Vector v(up[0], up[1], up[2]);
  const double length = v.length();
  if (length > 0 && std::isfinite(length))
    interactionOf(*impl_->engine).navigation.setUp(v / length);
}

void Browser::setTransition(double seconds) {
  interactionOf(*impl_->engine).viewer.setTransition(seconds);
}

std::vector<ViewpointName> Browser::viewpoints() const {
  std::vector<ViewpointName> list;
  for (Node* node : Binding::viewpoints(impl_->world->scope))
    list.push_back({NodeRef(node), node->defName, viewpointFields(node)->description});
  return list;
}

bool Browser::bindViewpoint(std::string_view name) {
  const std::vector<ViewpointName> list = viewpoints();
  if (const NodeRef known = node(name); known && isViewpoint(renderedNode(known.get())))
    return set(*renderedNode(known.get()), "set_bind", true);
  for (const auto member : {&ViewpointName::name, &ViewpointName::description})
    for (const ViewpointName& viewpoint : list)
      if (!name.empty() && viewpoint.*member == name) return set(*viewpoint.node, "set_bind", true);
  return false;
}

bool Browser::pick(const double origin[3], const double direction[3], const PickOptions& options,
                   PickHit& out) {
  Interaction& interaction = interactionOf(*impl_->engine);
  PickRay ray = rayOf(origin, direction);
  ray.nearest = options.nearest;
  ray.farthest = options.farthest;
  Hit hit;
  if (!interaction.picker.pick(ray, {options.collision, options.bothSides},
                               interaction.viewer.view(), impl_->world->scope.roots, hit))
    return false;
  out = {hit.t,
         {hit.point.x, hit.point.y, hit.point.z},
         {hit.normal.x, hit.normal.y, hit.normal.z},
         hit.texCoord,
         {}};
  for (const Hit::Step& step : hit.path)
    toArray(step.toWorld,
            out.path.emplace_back(PickHit::Step{NodeRef(step.node), {}}).toWorld.data());
  return true;
}

bool Browser::locate(Node& node, NodePlacement& placement) {
  const std::vector<Path> paths = pathsTo(node, 1);
  if (paths.empty()) return false;
  Interaction& interaction = interactionOf(*impl_->engine);
  placement = {};
  Path above;
  for (Node* one : paths.front()) {
    above.push_back(one);
    PickHit::Step& step = placement.path.emplace_back(PickHit::Step{NodeRef(one), {}});
    toArray(Picker::toWorld(above, interaction.viewer.view()), step.toWorld.data());
  }
  const PickBox box = interaction.picker.bounds({NodeRef(&node)});
  placement.bounds.empty = box.empty();
  if (!box.empty())
    for (int i = 0; i < 3; ++i) {
      placement.bounds.minimum[i] = box.low[i];
      placement.bounds.maximum[i] = box.high[i];
    }
  return true;
}

void Browser::setAspect(double aspect) {
  if (std::isfinite(aspect) && aspect > 0) interactionOf(*impl_->engine).aspect = aspect;
}

void Browser::pointer(double x, double y, bool button) {
  Interaction& interaction = interactionOf(*impl_->engine);
  const CameraSettings camera = interaction.viewer.camera(interaction.aspect);
  const CameraRay ray = rayThrough(camera, interaction.aspect, x, y);
  interaction.pointer.point(rayOf(ray.origin, ray.direction), button);
  impl_->runJobs(); // a Script may have requested another world
}

void Browser::pointerRay(const double origin[3], const double direction[3], bool button) {
  interactionOf(*impl_->engine).pointer.point(rayOf(origin, direction), button);
  impl_->runJobs();
}

void Browser::pointerLeave() {
  interactionOf(*impl_->engine).pointer.leave();
  impl_->runJobs();
}

std::vector<NodeRef> Browser::sensorsAtPointer() const {
  return interactionOf(*impl_->engine).pointer.sensors();
}

void Browser::activate(Node& node) {
  const auto* anchor = nodeCast<nodes::Anchor>(&node);
  if (!anchor || anchor->url.empty()) return;
  const std::string& first = anchor->url.front();
  if (first.starts_with('#') && bindViewpoint(std::string_view(first).substr(1))) return;
  if (impl_->onAnchor) return impl_->onAnchor(node);
  loadUrl(anchor->url, anchor->parameter, anchor->source.file ? *anchor->source.file : "");
}

void Browser::onAnchor(std::function<void(Node& anchor)> callback) {
  impl_->onAnchor = std::move(callback);
}

void Browser::navigate(const NavigationInput& input, double dt) {
  Engine& engine = *impl_->engine;
  if (engine.settling()) return;
  engine.beginCascade(engine.now());
  interactionOf(engine).navigation.move(input, dt);
  engine.settle();
  impl_->runJobs();
}

void Browser::key(Key key, bool pressed) {
  Engine& engine = *impl_->engine;
  if (engine.settling()) return;
  engine.beginCascade(engine.now());
  interactionOf(engine).navigation.key(key, pressed);
  engine.settle();
  impl_->runJobs();
}

bool Browser::worldKey(std::string_view name, bool pressed) {
  Engine& engine = *impl_->engine;
  if (engine.settling()) return false;
  engine.beginCascade(engine.now());
  const bool taken = interactionOf(engine).keyboard.key(name, pressed);
  engine.settle();
  impl_->runJobs();
  return taken;
}

bool Browser::worldText(std::string_view text) {
  bool taken = false;
  while (!text.empty()) {
    const size_t bytes = utf8Length(text);
    const std::string_view name = text[0] == '\n' ? "Enter" : text.substr(0, bytes);
    taken |= worldKey(name, true);
    worldKey(name, false);
    text.remove_prefix(bytes);
  }
  return taken;
}

bool Browser::sensesKeys() const { return interactionOf(*impl_->engine).keyboard.senses(); }

Navigation Browser::navigation() const { return interactionOf(*impl_->engine).navigation.type(); }

bool Browser::setNavigation(Navigation type) {
  return interactionOf(*impl_->engine).navigation.choose(type);
}

bool Browser::loadInline(Node& inlineNode) {
  Engine& engine = *impl_->engine;
  if (engine.settling()) return false;
  engine.beginCascade(engine.now());
  const bool loaded = loadInlineContent(engine, inlineNode);
  engine.settle();
  impl_->runJobs();
  return loaded;
}

uint64_t Browser::loadInlines() {
  Engine& engine = *impl_->engine;
  if (engine.settling()) return 0;
  engine.beginCascade(engine.now());
  const uint64_t loaded = loadInlinesBelow(engine, impl_->world->scope);
  engine.settle();
  impl_->runJobs();
  return loaded;
}

} // namespace xvrml
