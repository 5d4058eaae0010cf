// frame_view.h: the parts of a snapshot that follow from the view of a frame: camera, environment
// and lights in render space. A FrameView is what a commit says of them, so that a frame can show
// it with the structures of an earlier commit. Called by the local backend between frames, on the
// application thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "backend/local/thin.h"
#include "render/render_scene.h"
#include "scene/flatten.h"
#include "scene/scene.h"

namespace openrt {

// Index into RenderScene::lights by the id of a light.
using LightSlots = std::map<uint32_t, uint32_t>;

// These read the shaders and the origin of the snapshot.
void placeCamera(const Role& camera, RenderScene& next);
void placeEnvironment(const Role& environment, RenderScene& next);
// Fills the lights and the light sets. Lights whose shader or matrix is unusable have no slot.
LightSlots placeLights(const std::map<uint32_t, Light>& lights, const Flattened& flat,
                       RenderScene& next);
// Returns the distance between the rays of two neighbouring pixels in the middle of the picture.
// The width of lines and points is given in pixels.
PixelFootprint footprintOf(const RenderScene& scene);

// The view of the newest commit.
class FrameView {
 public:
  explicit FrameView(const Scene& scene)
      : frame_(scene.frame), camera_(scene.camera), lights_(scene.lights) {}
  // Takes the view from a later commit.
  void note(const Commit& commit);
  uint32_t cameraShader() const { return camera_.shader; }
  uint32_t number() const { return frame_.view; } // RT_VIEW
  // Returns a snapshot with the structures, shaders and lights of an earlier one, without the
  // tables for light. Lights that both have are where this view has them.
  std::shared_ptr<RenderScene> show(const RenderScene& earlier, const LightSlots& slots) const;

 private:
  edit::FrameSettingsT frame_;
  Role camera_;
  std::map<uint32_t, Light> lights_;
};

} // namespace openrt
