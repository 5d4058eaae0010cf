// render_scene.h: the immutable snapshot that a frame renders: records, shaders with their
// parameters, lights, camera and environment in render space. The local backend builds it between
// frames; all render threads read it.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "openrt/openrt.h"
#include "render/lights/emitters.h"
#include "render/lights/light_sampler.h"
#include "render/rays.h"
#include "render/records.h"
#include "render/surface/media.h"
#include "shading/texture.h"

namespace openrt {

class ShaderRegistry;
class LightSources;
class PhotonGuide;
struct Motions;

struct ShaderSlot {
  const RtsClass* shaderClass = nullptr;
  const void* params = nullptr;
  uint32_t traits = 0;
  uint16_t medium = 0; // 1 + index into ShaderTable::media(); 0: none
};

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

// Shaders of the scene with their parameter blocks. Slot 0 is the default surface shader.
class ShaderTable {
 public:
  ShaderTable(const Scene& scene, const ShaderRegistry& registry,
              const std::map<uint32_t, uint32_t>& textureIndex, const RtsHost& host);
  // Makes the table from an older one of the same scene, from which only the parameters of the
  // `changed` shaders differ.
  ShaderTable(const ShaderTable& before, const std::vector<uint32_t>& changed, const Scene& scene,
              const std::map<uint32_t, uint32_t>& textureIndex, const RtsHost& host);
  uint32_t slotOf(uint32_t shaderId) const; // slot of a surface shader; 0 for unknown ids
  const ShaderSlot& operator[](uint32_t slot) const { return slots_[slot]; }
  // Returns whether every shader of `other` has the same slot, class and traits here, so that
  // records made for it can be used with this table.
  bool extends(const ShaderTable& other) const;
  // Media with equal parameters are one, however many shaders have it, unless it scatters: then it
  // has the lights of its own shader's surfaces.
  std::span<const RtsMedium> media() const { return media_; }
  // Returns whether more than one shader has a medium.
  bool severalBodies() const { return bodies_ > 1; }
  // Returns the slot of a light, camera or environment shader; shaderClass is null if the id is not
  // of that kind.
  ShaderSlot role(uint32_t shaderId, RtsKind kind) const;

 private:
  struct Block { // the parameter struct and the lists and strings it points to
    std::unique_ptr<std::byte[]> bytes;
    std::vector<std::vector<float>> lists;
    std::vector<std::unique_ptr<std::string>> strings;
    const RtsClass* prepared = nullptr; // class whose `release` must be called
    Block() = default;
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    ~Block();
  };
  using Slots = std::map<uint32_t, uint32_t>; // slot by shader id
  bool make(uint32_t slot, const RtsClass& shaderClass, const ShaderValues* values,
            const std::map<uint32_t, uint32_t>& textureIndex, const RtsHost& host);
  void setMedium(ShaderSlot& slot, const RtsHost& host);
  void countUse(uint16_t medium, bool more);
  std::vector<ShaderSlot> slots_;
  // Indexed by slot. Tables share the blocks that have not changed.
  std::vector<std::shared_ptr<const Block>> blocks_;
  // Indexed by slot: the class that the scene requests, even if the default shader replaces it.
  std::vector<const RtsClass*> classes_;
  std::vector<RtsMedium> media_;
  std::vector<uint32_t> users_;             // by medium: number of slots that have it
  std::map<std::string, uint16_t> numbers_; // by the bytes of a medium that slots may share
  uint32_t bodies_ = 0;                     // number of slots that have a medium
  std::shared_ptr<const Slots> slotOf_;
  uint32_t defaultShader_ = 0; // the shader that slot 0 takes its values from
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
  Emitters emitters;             // path tracing: emissive surfaces and the environment
  // RT_MOTION (motion.h). Null: the frame lacks the channel, or nothing has moved.
  std::shared_ptr<const Motions> motions;
  // Indexed by light set. Null: every light is evaluated at every hit.
  std::shared_ptr<const std::vector<LightSampler>> lightSamplers;
  std::shared_ptr<const LightSources>
      lightSources; // light tracing; null if there is nothing to trace
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

// Fills in the host table's functions (render/surface/host.cpp).
void fillHost(RtsHost& host);

} // namespace openrt
