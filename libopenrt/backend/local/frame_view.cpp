#include "backend/local/frame_view.h"

#include <cmath>

#include "render/wave/batch.h"
#include "shading/running.h"

namespace openrt {
namespace {

// Returns a matrix of the world, moved to render space.
Matrix4d inRenderSpace(Matrix4d matrix, const RenderScene& scene) {
  matrix.translate(vectorOf(scene.origin) * -1.0);
  return matrix;
}

void placeRole(const Role& role, RtsKind kind, const RenderScene& scene, RoleSlot& slot) {
  if (!role.shader || !role.matrix.usable()) return;
  slot.shader = scene.shaders->role(role.shader, kind);
  const Matrix4d matrix = inRenderSpace(role.matrix, scene);
  slot.fromLocal = Affine::from(matrix);
  slot.toLocal = Affine::from(inverse(matrix));
}

} // namespace

void placeEnvironment(const Role& environment, RenderScene& next) {
  placeRole(environment, RTS_ENVIRONMENT, next, next.environment);
}

void placeCamera(const Role& camera, RenderScene& next) {
  placeRole(camera, RTS_CAMERA, next, next.camera);
  if (!next.camera.shader.shaderClass) return;
  const Vec3d axis = camera.matrix.column(2) * (-1 / length(camera.matrix.column(2)));
  next.eye = next.camera.fromLocal.translation();
  next.viewAxis = Vec3f(axis);
  next.depthAxis = next.viewAxis;
  const Vec3d normal = cross(camera.matrix.column(0), camera.matrix.column(1));
  const double along = dot(normal, axis) / length(normal);
  constexpr double rounding = 1e-12;
  if (std::abs(along) < 1 - rounding)
    next.depthAxis = Vec3f(normal * ((along < 0 ? -1 : 1) / length(normal)));
}

PixelFootprint footprintOf(const RenderScene& scene) {
  PixelFootprint result;
  result.eye = scene.eye;
  result.axis = scene.viewAxis;
  const ShaderSlot& camera = scene.camera.shader;
  if (!camera.shaderClass) return result;
  Arena arena;
  float *xy[2], *org[3], *dir[3];
  for (auto* group : {org, dir})
    for (int k = 0; k < 3; k++) group[k] = arena.takeZero<float>(lanes);
  for (auto& a : xy) a = arena.takeZero<float>(lanes);
  const float size[2] = {float(scene.frame.width), float(scene.frame.height)};
  for (uint32_t i = 0; i < lanes; i++) {
    xy[0][i] = size[0] / 2;
    xy[1][i] = size[1] / 2 + (i == 1 ? 1.0f : 0.0f);
  }
  const float* points[2] = {xy[0], xy[1]};
  RtsRays rays;
  for (int k = 0; k < 3; k++) {
    rays.origin[k] = org[k];
    rays.direction[k] = dir[k];
  }
  RayCounters counters;
  RtsBatch batch({scene, arena, counters});
  batch.lanes = {.count = lanes, .cameraRays = true};
  {
    const RunningShader running(*camera.shaderClass);
    camera.shaderClass->generate(&scene.host, &batch, camera.params, 2, points, size, &rays);
  }
  // In local space the view axis is -z. Compare the positions of the rays at depths 0 and 1.
  const auto at = [&](int i, int k, float depth) {
    return org[k][i] + dir[k][i] * (depth + org[2][i]) / -dir[2][i];
  };
  result.constant = std::hypot(at(1, 0, 0) - at(0, 0, 0), at(1, 1, 0) - at(0, 1, 0));
  result.slope = std::hypot(at(1, 0, 1) - at(0, 0, 1), at(1, 1, 1) - at(0, 1, 1)) - result.constant;
  if (!std::isfinite(result.constant) || !std::isfinite(result.slope))
    result.constant = result.slope = 0;
  return result;
}

LightSlots placeLights(const std::map<uint32_t, Light>& lights, const Flattened& flat,
                       RenderScene& next) {
  LightSlots slots;
  for (const auto& [id, light] : lights) {
    const ShaderSlot shader = next.shaders->role(light.shader, RTS_LIGHT);
    if (!shader.shaderClass || !light.matrix.usable()) continue;
    const Matrix4d matrix = inRenderSpace(light.matrix, next);
    slots[id] = uint32_t(next.lights.size());
    next.lights.push_back({shader, Affine::from(inverse(matrix)), Affine::from(matrix)});
  }
  for (const auto& ids : flat.lightSets) {
    auto& set = next.lightSets.emplace_back();
    for (const uint32_t id : ids)
      if (const auto found = slots.find(id); found != slots.end()) set.push_back(found->second);
  }
  return slots;
}

void FrameView::note(const Commit& commit) {
  for (const auto& edit : commit.edits.edits) {
    if (!edit) continue;
    if (const auto* settings = edit->any.AsFrameSettings()) frame_ = *settings;
    if (const auto* camera = edit->any.AsCamera())
      camera_ = {camera->shader, toMatrix(camera->matrix.get())};
    if (const auto* light = edit->any.AsLight())
      lights_[light->id] = {light->shader, light->scope, toMatrix(light->matrix.get())};
    if (const auto* gone = edit->any.AsDeleteLight()) lights_.erase(gone->id);
  }
}

std::shared_ptr<RenderScene> FrameView::show(const RenderScene& earlier,
                                             const LightSlots& slots) const {
  auto next = std::make_shared<RenderScene>();
  next->frame = frame_;
  next->host = earlier.host;
  next->textures = earlier.textures;
  next->shaders = earlier.shaders;
  next->transport = earlier.transport;
  next->kernel = earlier.kernel;
  next->records = earlier.records;
  next->buckets = earlier.buckets;
  next->transparentShadows = earlier.transparentShadows;
  next->environment = earlier.environment;
  next->motions = earlier.motions;
  store(vectorOf(earlier.origin), next->origin);
  placeCamera(camera_, *next);
  next->lightSets = earlier.lightSets;
  next->lights = earlier.lights;
  for (const auto& [id, slot] : slots) {
    const auto found = lights_.find(id);
    if (found == lights_.end() || !found->second.matrix.usable()) continue;
    const Matrix4d matrix = inRenderSpace(found->second.matrix, *next);
    next->lights[slot].toLocal = Affine::from(inverse(matrix));
    next->lights[slot].fromLocal = Affine::from(matrix);
  }
  return next;
}

} // namespace openrt
