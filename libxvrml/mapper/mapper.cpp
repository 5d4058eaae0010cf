// mapper.cpp: OpenRTMapper: the steps from a world to rt* calls, frame by frame. The interface is
// in xvrml/mapper.h.
#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "geometry/lens.h"
#include "mapper/extent.h"
#include "mapper/mapper_impl.h"
#include "mapper/model.h"
#include "nodes/viewpoint.h"

namespace xvrml {

using namespace mapper;

OpenRTMapper::Impl::Impl(World& w, const MapOptions& o)
    : world(w), options(o), graph(w), places(w), textures(w, o.linearColor), cubes(w, textures),
      volumes(w, textures), custom(w, classes, textures),
      surfaces(w, o.linearColor, classes, textures, cubes, volumes, custom),
      objects(w, o.linearColor, graph, places, surfaces), lights(w, o.linearColor, classes, custom),
      fogs(w, o.linearColor, classes),
      environment(w, o.linearColor, classes, textures, cubes, custom),
      camera(cameraOf(nullptr, Matrix(), o.aspect)) {
  summarise(graph, world.diagnostics);
  std::vector<Place> gone;
  places.build(graph, gone);
  places.updateForFrame(graph, camera); // content of billboards is placed for the default view
  rebind();
}

OpenRTMapper::Impl::~Impl() {
  if (!context || rtGetCurrent() != context) return;
  try {
    lights.clear(places);
    fogs.clear(places);
    objects.clear();
    environment.clear();
    surfaces.clear();
    custom.clear();
    cubes.clear();
    volumes.clear();
    textures.clear();
  } catch (const std::bad_alloc&) {} // the remaining objects are freed with the context
}

void OpenRTMapper::Impl::rebind() {
  if (!given) {
    bound = firstBound(graph, places);
    return;
  }
  BoundNodes nodes;
  nodes.viewpoint = given->viewpoint.get();
  nodes.background = given->background.get();
  nodes.fog = given->fog.get();
  nodes.navigationInfo = given->navigationInfo.get();
  bound = boundTo(graph, places, nodes);
}

CameraSettings OpenRTMapper::Impl::cameraAt(int32_t place) const {
  if (place == none) return cameraOf(nullptr, Matrix(), options.aspect);
  const Place& p = places.all[size_t(place)];
  return cameraOf(graph.items[p.item].node.get(), p.world, options.aspect);
}

bool OpenRTMapper::Impl::headlight() const {
  if (options.headlight != MapOptions::Headlight::automatic)
    return options.headlight == MapOptions::Headlight::on;
  return hasHeadlight(bound);
}

const std::vector<int32_t>& OpenRTMapper::Impl::viewpointPlaces() {
  if (!viewsStale) return viewpointPlaces_;
  viewsStale = false;
  places.updateForFrame(graph, camera);
  viewpointPlaces_.clear();
  viewpoints_ = listViewpoints(graph, places, viewpointPlaces_);
  return viewpointPlaces_;
}

const std::vector<ViewpointInfo>& OpenRTMapper::Impl::viewpoints() {
  viewpointPlaces();
  return viewpoints_;
}

const Bounds& OpenRTMapper::Impl::bounds() {
  if (boundsStale) {
    places.updateForFrame(graph, camera);
    bounds_ = boundsOf(graph, places);
    sphereStale = outermostStale = true;
    facing_.clear();
  }
  boundsStale = false;
  return bounds_;
}

const BoundingSphere& OpenRTMapper::Impl::sphere() {
  const Bounds& box = bounds();
  if (sphereStale) sphere_ = sphereOf(graph, places, box);
  sphereStale = false;
  return sphere_;
}

const std::vector<Vector>& OpenRTMapper::Impl::outermost() {
  bounds();
  if (outermostStale) outermost_ = outermostPoints(graph, places, Outermost::even());
  outermostStale = false;
  return outermost_;
}

bool OpenRTMapper::Impl::facesAway(const double view[16]) {
  bounds(); // forgets what has changed
  const auto [known, fresh] = facing_.try_emplace({view[8], view[9], view[10]});
  if (fresh) known->second = xvrml::facesAway(world, view);
  return known->second;
}

bool OpenRTMapper::Impl::followsCamera() const {
  return std::any_of(places.all.begin(), places.all.end(), [&](const Place& place) {
    const Kind kind = graph.items[place.item].kind;
    return kind == Kind::billboard || kind == Kind::lod;
  });
}

std::vector<Vector>
OpenRTMapper::Impl::outermostFor(const CameraSettings& seen,
                                 const std::optional<Outermost::Directions>& more) {
  places.updateForFrame(graph, seen);
  std::vector<Vector> points = outermostPoints(graph, places, Outermost::even());
  if (!more) return points;
  const std::vector<Vector> across = outermostPoints(graph, places, *more);
  points.insert(points.end(), across.begin(), across.end());
  return points;
}

// Billboards and LODs follow the camera that is being placed. So the camera is placed again for
// what the one before sees, until that stays as it is. If the levels of an LOD alternate, the
// camera sees both.
CameraSettings OpenRTMapper::Impl::fit(const double view[16], double fovy, double aspect) {
  constexpr int rounds = 4;
  const auto more = directionsAcross(view, fovy, aspect);
  const bool follows = followsCamera();
  if (!more && !follows) return mapper::cameraAround(outermost(), view, fovy, aspect);
  std::vector<Vector> before = outermostFor(camera, more), points = before;
  CameraSettings fitted = mapper::cameraAround(points, view, fovy, aspect);
  for (int round = 1; follows && round < rounds; ++round) {
    std::vector<Vector> now = outermostFor(fitted, more);
    if (now == before) break;
    if (round == 1) points.clear();
    points.insert(points.end(), now.begin(), now.end());
    before = std::move(now);
    fitted = mapper::cameraAround(points, view, fovy, aspect);
  }
  places.updateForFrame(graph, camera);
  return fitted;
}

bool OpenRTMapper::Impl::lightsModel() {
  if (!modelLight || options.headlight != MapOptions::Headlight::automatic || bound.viewpoint)
    return false;
  if (lightStale) hasUnspecifiedLighting_ = hasUnspecifiedLighting(graph, bound);
  lightStale = false;
  return hasUnspecifiedLighting_;
}

OpenRTMapper::OpenRTMapper(World& world, const MapOptions& options)
    : impl_(std::make_unique<Impl>(world, options)) {}
OpenRTMapper::~OpenRTMapper() = default;

const std::vector<ViewpointInfo>& OpenRTMapper::viewpoints() const { return impl_->viewpoints(); }

int OpenRTMapper::boundViewpoint() const {
  const std::vector<int32_t>& places = impl_->viewpointPlaces();
  const auto found = std::find(places.begin(), places.end(), impl_->bound.viewpointPlace);
  return found == places.end() ? -1 : int(found - places.begin());
}

std::vector<SensorInfo> OpenRTMapper::sensors() const {
  impl_->places.updateForFrame(impl_->graph, impl_->camera);
  return listSensors(impl_->graph, impl_->places, impl_->world.diagnostics);
}

std::vector<SensorInfo> OpenRTMapper::lamps() const {
  impl_->places.updateForFrame(impl_->graph, impl_->camera);
  return listLamps(impl_->graph, impl_->places);
}

CameraSettings OpenRTMapper::viewpointCamera(size_t index) const {
  const std::vector<int32_t>& places = impl_->viewpointPlaces();
  CameraSettings camera = impl_->cameraAt(index < places.size() ? places[index] : none);
  if (index >= places.size()) return camera;
  // viewAll of X3D, as Viewer::seeAll has it
  const Place& place = impl_->places.all[size_t(places[index])];
  const auto fields = viewpointFields(impl_->graph.items[place.item].node.get());
  if (!fields || !fields->viewAll || !*fields->viewAll || impl_->bounds().empty) return camera;
  const Bounds& box = impl_->bounds();
  const auto view = viewOfAll(*fields, Vector(box.minimum[0], box.minimum[1], box.minimum[2]),
                              Vector(box.maximum[0], box.maximum[1], box.maximum[2]));
  if (!view) return camera;
  for (int i = 0; i < 3; ++i)
    camera.matrix[12 + i] = view->middle[i] + camera.matrix[8 + i] * view->distance;
  if (view->radius > 0) showSphere(camera, view->radius, impl_->options.aspect);
  return camera;
}

CameraSettings OpenRTMapper::fitCamera(double fovy) const {
  const CameraSettings first = viewpointCamera(size_t(std::max(0, boundViewpoint())));
  return cameraAround(first.matrix, fovy, impl_->options.aspect);
}

CameraSettings OpenRTMapper::cameraAround(const double view[16], double fovy, double aspect) const {
  return impl_->fit(view, fovy, aspect);
}

bool OpenRTMapper::seesAll(const CameraSettings& camera, double aspect) const {
  if (!impl_->followsCamera()) return mapper::seesAll(impl_->outermost(), camera, aspect);
  const std::vector<Vector> points = impl_->outermostFor(camera, {});
  impl_->places.updateForFrame(impl_->graph, impl_->camera);
  return mapper::seesAll(points, camera, aspect);
}

void OpenRTMapper::setExactShapes(bool exact) { impl_->graph.meshes.setExactShapes(exact); }

void OpenRTMapper::setThickness(double points, double lines) {
  impl_->graph.meshes.setThickness(float(points), float(lines));
}

void OpenRTMapper::setMultiplyTextures(bool multiply) {
  impl_->surfaces.multiplyTextures = multiply;
}
void OpenRTMapper::setHeadlight(MapOptions::Headlight headlight) {
  impl_->options.headlight = headlight;
}

void OpenRTMapper::setModelLight(bool on) { impl_->modelLight = on; }

void OpenRTMapper::setBackground(bool on) { impl_->background = on; }

bool OpenRTMapper::facesAway(const double view[16]) const { return impl_->facesAway(view); }

Bounds OpenRTMapper::bounds() const { return impl_->bounds(); }

BoundingSphere OpenRTMapper::boundingSphere() const { return impl_->sphere(); }

UpGuess OpenRTMapper::guessUp() const {
  return mapper::guessUp(impl_->world, impl_->graph, impl_->bounds());
}

void OpenRTMapper::bind(const BoundNodes& nodes) {
  const Bound before = impl_->bound;
  impl_->given = boundTo(impl_->graph, impl_->places, nodes);
  impl_->bound = *impl_->given;
  impl_->lightStale |= before.navigationInfo != impl_->bound.navigationInfo ||
                       before.background != impl_->bound.background;
}

void OpenRTMapper::update(const FieldChanges& changes) { impl_->update(changes); }

void OpenRTMapper::setPatient(bool patient) { impl_->patient = patient; }

uint64_t OpenRTMapper::readBeside() const { return impl_->graph.meshes.readBeside(); }

bool OpenRTMapper::isBehind() const { return impl_->rootsAwait || !impl_->awaiting.empty(); }

void OpenRTMapper::map(const CameraSettings& camera) {
  Impl& m = *impl_;
  report(m.world.diagnostics, {}, "before the world was mapped");
  m.camera = camera;
  m.places.updateForFrame(m.graph, camera);
  if (!std::exchange(m.clearTold, true))
    if (const size_t shapes = countIfAllClear(m.graph))
      m.world.diagnostics.warn(
          {std::make_shared<const std::string>(m.world.path), 0, 0},
          fmt::format("nothing can be seen: the material of {} has transparency 1",
                      shapes == 1 ? "the only Shape"
                                  : fmt::format("each of the {} Shapes", shapes)));
  Bound around = m.bound;
  if (!m.background) {
    around.background = {};
    around.backgroundPlace = none;
  }
  if (const int32_t fog = Fogs::outermost(m.graph, m.places); fog != none) {
    around.fog = m.graph.items[m.places.all[size_t(fog)].item].node;
    around.fogPlace = fog;
  }
  m.environment.updateForFrame(m.graph, m.places, around);
  m.objects.updateForFrame();
  m.fogs.updateForFrame(m.graph, m.places);
  m.lights.updateForFrame(m.graph, m.places);
  m.lights.atCamera(m.lightsModel() ? CameraLight::model
                    : m.headlight() ? CameraLight::head
                                    : CameraLight::none,
                    camera);
  m.graph.meshes.release(); // the context has its own copy
  m.useCamera(camera);
  m.custom.sweep();
}

void OpenRTMapper::Impl::useCamera(const CameraSettings& settings) {
  const double degrees = settings.fovy * 180 / std::numbers::pi;
  constexpr double farthest = 1e17; // for the renderer
  const double* place = settings.matrix + 12;
  if (!(std::hypot(place[0], place[1], place[2]) <= farthest) && !farCameraTold) {
    farCameraTold = true;
    world.diagnostics.warn(bound.viewpoint ? bound.viewpoint->source : SourcePosition(),
                           "the camera stands farther than 1e17 from the origin; nothing is drawn "
                           "from there");
  }
  rtLoadMatrixd(settings.matrix);
  RTid shader = 0;
  if (auto* node = nodeCast<nodes::ORTShader>(
          settings.shader)) // a camera shader of its own: other views may have another angle
    shader = custom.shaderFor(*node, RT_CAMERA, node,
                              [&](ShaderSetup& setup, const ShaderClass& shaderClass) {
                                if (shaderClass.has("fovy") && settings.fovy > 0)
                                  setup.number("fovy", float(degrees));
                                if (shaderClass.has("height") && settings.fovy == 0)
                                  setup.number("height", float(settings.height));
                              });
  if (shader != 0)
    rtUseCamera(shader);
  else if (settings.fovy == 0)
    rtOrtho(settings.height);
  else
    rtPerspective(degrees);
  report(world.diagnostics, settings.shader ? settings.shader->source : SourcePosition(), "camera");
}

MapStats OpenRTMapper::stats() const {
  Impl& m = *impl_;
  if (m.countsStale) recount(m.graph);
  m.countsStale = false;
  const Item& root = m.graph.items[Graph::root];
  MapStats s;
  s.shapes = root.shapes;
  s.triangles = root.triangles;
  s.lights = m.lights.count();
  s.textures = m.textures.count();
  s.objects = m.objects.objects();
  s.instances = m.objects.instances();
  s.missingTextures = m.textures.missing();
  s.objectsDefined = m.objects.definitions();
  s.instancesMoved = m.objects.moves();
  s.parametersSet = m.surfaces.parametersSet() + m.custom.parametersSet() +
                    m.lights.parametersSet() + m.fogs.parametersSet() +
                    m.environment.parametersSet();
  s.texturesLoaded = m.textures.loaded();
  s.lightsChanged = m.lights.changes();
  s.regroupings = m.regroupings;
  return s;
}

const std::vector<std::string>& OpenRTMapper::names() const {
  if (impl_->namesStale) impl_->names = impl_->graph.shapeNames();
  impl_->namesStale = false;
  return impl_->names;
}

std::vector<NodeRef> OpenRTMapper::nodes() const {
  std::vector<NodeRef> nodes;
  nodes.reserve(impl_->graph.shapes.size());
  for (const ItemId id : impl_->graph.shapes)
    nodes.push_back(id == 0 ? NodeRef() : impl_->graph.items[id].node);
  return nodes;
}

} // namespace xvrml
