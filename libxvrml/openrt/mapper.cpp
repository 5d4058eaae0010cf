// mapper.cpp: OpenRTMapper: the order of the steps from a world to rt* calls. See xvrml/openrt.h.
#include "xvrml/openrt.h"

#include <algorithm>
#include <numbers>

#include "openrt/appearance.h"
#include "openrt/extent.h"
#include "openrt/lights.h"
#include "openrt/objects.h"
#include "openrt/places.h"
#include "openrt/views.h"

namespace xvrml {

using namespace mapping;

namespace {
// Meshes first: what is shared depends on how much there is to share.
Graph& summarised(Graph& graph, World& world) {
  summarise(graph, world.diagnostics);
  return graph;
}
} // namespace

struct OpenRTMapper::Impl {
  World& world;
  MapOptions options;
  Graph graph;
  Places places;
  Bound bound;
  std::vector<int32_t> viewpointPlaces;
  std::vector<ViewpointInfo> viewpoints;
  Bounds bounds;
  ShaderClasses classes;
  Textures textures;
  Surfaces surfaces;
  Objects objects;
  Lights lights;
  bool environmentUsed = false;
  std::optional<BoundNodes> boundNodes;

  Impl(World& w, const MapOptions& o)
      : world(w), options(o), graph(w), places(summarised(graph, w)), bound(firstBound(graph, places)),
        textures(w, o.linearColor), surfaces(w, o.linearColor, classes, textures),
        objects(w, o.linearColor, graph, places, surfaces), lights(w, o.linearColor, classes) {
    places.follow(graph, cameraOf(nullptr, Matrix(), o.aspect)); // bindables below billboards: as seen from the default view
    viewpoints = listViewpoints(graph, places, viewpointPlaces);
    bounds = boundsOf(graph, places);
  }

  CameraSettings cameraAt(int32_t place) const {
    if (place == none) return cameraOf(nullptr, Matrix(), options.aspect);
    const Place& p = places.all[size_t(place)];
    return cameraOf(graph.items[p.item].node, p.world, options.aspect);
  }

  bool headlight() const {
    if (options.headlight != MapOptions::Headlight::automatic) return options.headlight == MapOptions::Headlight::on;
    return hasHeadlight(graph, places, bound);
  }
};

OpenRTMapper::OpenRTMapper(World& world, const MapOptions& options) : impl_(std::make_unique<Impl>(world, options)) {}
OpenRTMapper::~OpenRTMapper() = default;

const std::vector<ViewpointInfo>& OpenRTMapper::viewpoints() const { return impl_->viewpoints; }

int OpenRTMapper::boundViewpoint() const {
  for (size_t i = 0; i < impl_->viewpointPlaces.size(); ++i)
    if (impl_->viewpointPlaces[i] == impl_->bound.viewpoint) return int(i);
  return -1;
}

CameraSettings OpenRTMapper::viewpointCamera(size_t index) const {
  return impl_->cameraAt(index < impl_->viewpointPlaces.size() ? impl_->viewpointPlaces[index] : none);
}

CameraSettings OpenRTMapper::fitCamera(double fovy) const {
  const CameraSettings first = viewpointCamera(size_t(std::max(0, boundViewpoint())));
  return cameraAround(impl_->bounds, fromArray(first.matrix), fovy, impl_->options.aspect);
}

Bounds OpenRTMapper::bounds() const { return impl_->bounds; }

void OpenRTMapper::map(const CameraSettings& camera) {
  Impl& m = *impl_;
  report(m.world.diagnostics, {}, "before the world was mapped");
  if (!m.environmentUsed) rtUseEnvironment(0);
  if (!m.environmentUsed) useEnvironment(m.world, m.options.linearColor, m.graph, m.places, m.bound, m.classes, m.textures);
  m.environmentUsed = true;
  m.places.follow(m.graph, camera);
  m.objects.follow();
  m.lights.follow(m.graph, m.places);
  m.lights.headlight(m.headlight(), camera);
  m.graph.meshes.release(); // the context has its own copy
  rtLoadMatrixd(camera.matrix);
  if (camera.fovy == 0)
    rtOrtho(camera.height);
  else
    rtPerspective(camera.fovy * 180 / std::numbers::pi);
  report(m.world.diagnostics, {}, "camera");
}

void OpenRTMapper::bind(const BoundNodes& nodes) {
  Impl& m = *impl_;
  m.bound = placesOf(m.graph, m.places, nodes);
  m.boundNodes = nodes;
  m.environmentUsed = false;
}

// All anew, for the time being.
void OpenRTMapper::update(const FieldChanges& changes) {
  if (changes.empty()) return;
  Impl& old = *impl_;
  const auto boundNodes = old.boundNodes;
  World& world = old.world;
  const MapOptions options = old.options;
  old.objects.remove();
  old.lights.remove(old.places);
  rtUseEnvironment(0);
  impl_ = std::make_unique<Impl>(world, options);
  if (boundNodes) bind(*boundNodes);
}

std::vector<ExplainedObject> OpenRTMapper::explain() const {
  const Impl& m = *impl_;
  const Item& root = m.graph.items[m.graph.root];
  ExplainedObject world;
  world.name = "world";
  world.reason = "merged static geometry of " + std::to_string(root.shapes) + " shapes";
  world.triangles = root.triangles;
  world.shapes = root.shapes;
  world.bytes = 150 * root.triangles;
  world.instances = 1;
  return {world};
}

MapStats OpenRTMapper::stats() const {
  const Impl& m = *impl_;
  const Item& root = m.graph.items[m.graph.root];
  return {root.shapes,         root.triangles,        m.lights.count(),    m.textures.count(),
          m.objects.objects(), m.objects.instances(), m.textures.missing()};
}

const std::vector<std::string>& OpenRTMapper::names() const { return impl_->graph.names; }

} // namespace xvrml
