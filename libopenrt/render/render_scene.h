// render_scene.h: the immutable snapshot that a frame renders: records, shaders with their
// parameters, lights, camera and environment in render space. The local backend builds it between
// frames; all render threads read it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "openrt/openrt.h"
#include "render/media.h"
#include "render/rays.h"
#include "render/records.h"
#include "render/shader_table.h"
#include "shading/texture.h"

namespace openrt {

class Emitters;
class LightSampler;
class LightSources;
class PhotonGuide;
struct Motions;

struct LightSlot {
  ShaderSlot shader;
  Affine toLocal;   // render space -> light's space
  Affine fromLocal; // light's space -> render space
};

struct RoleSlot {
  ShaderSlot shader; // shaderClass null if there is none
  Affine toLocal, fromLocal;
};

// The lights that shine on a medium that scatters.
struct MediumLights {
  uint32_t set = 0; // index into RenderScene::lightSets
  // Render space: the positions of its lights that declare one. Empty if they are many.
  std::vector<Vec3f> lamps;
};

// The host table that shaders see, and the data that its functions need.
struct RenderHost : RtsHost {
  const std::vector<Texture>* textures = nullptr;
  RTlogCallback logCallback = nullptr;
  void* logUser = nullptr;
  bool diagnose = false; // check shader output against the declared traits
};

struct RenderScene {
  std::shared_ptr<const Intersector> kernel;
  std::span<const Record> records; // records of the kernel
  std::span<const Bucket> buckets;
  std::vector<std::vector<uint32_t>> lightSets; // indices into lights
  std::vector<LightSlot> lights;
  std::shared_ptr<const std::vector<Texture>> textures; // [0] is the missing texture
  // Shared between snapshots while unchanged, like the textures.
  std::shared_ptr<const ShaderTable> shaders;
  RoleSlot camera, environment;
  ShaderSlot transport;          // shaderClass null: the engine's own transport
  Vec3f eye, viewAxis{0, 0, -1}; // render space; unit
  double origin[3] = {0, 0, 0};  // world position of render space's origin
  // Path tracing: emissive surfaces and the environment. Null: the scene is ready for ray queries,
  // but not for a frame.
  std::shared_ptr<Emitters> emitters;
  // RT_MOTION (motion.h). Null: the frame lacks the channel, or nothing has moved.
  std::shared_ptr<const Motions> motions;
  // Indexed by light set. Null: every light is evaluated at every hit.
  std::shared_ptr<const std::vector<LightSampler>> lightSamplers;
  std::shared_ptr<const LightSources>
      lightSources; // light tracing; null if there is nothing to trace
  // Light paths that a glossy surface scatters first (lights/light_path_weights.h); null: camera
  // paths make all of these.
  std::shared_ptr<const LightSources> glossySources;
  // Where these light paths are connected: to the camera, and to the first non-specular surfaces of
  // camera paths behind mirrors and glass.
  bool showsGlossy = false, connectsGlossy = false;
  // Camera paths share the light of emissive shapes that lightSources send by way of mirrors and
  // glass; else light paths make all of it.
  bool sharesMirrors = false;
  // How many light paths of lightSources go with one camera path (path/light_path_trial.h).
  uint32_t lightPathsOfCameraPath = 1;
  // Returns whether camera paths count how often light paths make them.
  bool countsLightPaths() const { return glossySources || sharesMirrors; }
  // By medium (ShaderTable::media). Empty: the transport does not follow paths, or no medium of the
  // scene fills space (fillsSpace()).
  std::vector<MediumLights> mediumLights;
  // Guides camera paths to emissive shapes by way of specular surfaces; null: there is nothing to
  // guide to, or too few samples are taken.
  std::shared_ptr<const PhotonGuide> photonGuide;
  // Flux of one of the light paths that have left the photons, summed over the colours: whatever
  // they have found is sampled, so they bound what they have not found. 0: they tell nothing.
  double lightPathFlux = 0;
  bool transparentShadows = false; // something transparent may lie between a point and a light
  bool absorbingShadows = false;   // so may a medium that absorbs
  // Light samples pass what transmits straight on, and boundaries of media that have no effect
  // (render/lights/shadows.h).
  bool samplesPass = false;
  // The media that contain the eye, in scenes where their paths do not look for them.
  MediaStack aroundEye{};
  // Whether rays from the eye in all directions seldom leave the scene.
  bool enclosed = false;
  // skyKnown: whether the environment was tested for light. skyShines: whether it emits light.
  bool skyKnown = false, skyShines = false;
  RenderHost host;
  edit::FrameSettingsT frame;
  // RT_DEPTH is along it: perpendicular to the picture, and viewAxis unless the camera's matrix
  // shears the picture.
  Vec3f depthAxis{0, 0, -1};
};

// Fills in the host table's functions (render/path/host.cpp).
void fillHost(RtsHost& host);

} // namespace openrt
