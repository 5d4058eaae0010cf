// render_scene.h: the immutable snapshot that a frame renders: records, shaders with their
// parameters, lights, camera and environment in render space. Made between frames by the local
// backend, read by all render threads.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "openrt/openrt.h"
#include "render/lights/emitters.h"
#include "render/lights/many_lights.h"
#include "render/rays.h"
#include "render/records.h"
#include "shading/texture.h"

namespace openrt {

class ShaderRegistry;
class LightSources;

struct ShaderSlot {
  const RtsClass* shaderClass = nullptr;
  const void* params = nullptr;
  uint32_t traits = 0;
  uint16_t medium = 0; // 1 + its place in ShaderTable::media()
};

struct LightSlot {
  ShaderSlot shader;
  Affine toLocal;   // render space -> light's space
  Affine fromLocal; // vectors: light's space -> render space
};

struct RoleSlot {
  ShaderSlot shader; // shaderClass null: none
  Affine toLocal, fromLocal;
};

// The host table that shaders see, with what its functions need behind it.
struct RenderHost : RtsHost {
  const std::vector<Texture>* textures = nullptr;
  RTlogCallback logCallback = nullptr;
  void* logUser = nullptr;
  bool diagnose = false; // shaders are held to what their traits say
};

// Shaders of the scene with their parameter blocks. Slot 0 is the default surface shader.
class ShaderTable {
 public:
  ShaderTable(const Scene& scene, const ShaderRegistry& registry,
              const std::map<uint32_t, uint32_t>& textureIndex, const RtsHost& host);
  // The same scene after parameters of these shaders changed, and nothing else of shaders and
  // textures.
  ShaderTable(const ShaderTable& before, const std::vector<uint32_t>& changed, const Scene& scene,
              const std::map<uint32_t, uint32_t>& textureIndex, const RtsHost& host);
  uint32_t slotOf(uint32_t shaderId) const; // surface shaders; unknown ids: slot 0
  const ShaderSlot& operator[](uint32_t slot) const { return slots_[slot]; }
  // Everything of the other has the same slot, class and traits here: records made for it serve
  // this one.
  bool extends(const ShaderTable& other) const;
  std::span<const RtsMedium> media() const { return media_; }
  // The slot of a light, camera or environment shader; shaderClass null if it is none of that kind.
  ShaderSlot role(uint32_t shaderId, RtsKind kind) const;

 private:
  struct Block { // parameter struct and what it points to
    std::unique_ptr<std::byte[]> bytes;
    std::vector<std::vector<float>> lists;
    std::vector<std::unique_ptr<std::string>> strings;
    const RtsClass* prepared = nullptr; // whose `release` is due
    Block() = default;
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    ~Block();
  };
  using Slots = std::map<uint32_t, uint32_t>; // by shader id
  bool make(uint32_t slot, const RtsClass& shaderClass, const ShaderValues* values,
            const std::map<uint32_t, uint32_t>& textureIndex, const RtsHost& host);
  void setMedium(ShaderSlot& slot, const RtsHost& host);
  std::vector<ShaderSlot> slots_;
  std::vector<std::shared_ptr<const Block>>
      blocks_;                           // by slot; tables share those that did not change
  std::vector<const RtsClass*> classes_; // by slot, also where another stands for what was refused
  std::vector<RtsMedium> media_;
  std::shared_ptr<const Slots> slotOf_;
  uint32_t defaultShader_ = 0; // the shader whose values slot 0 has
};

struct RenderScene {
  std::shared_ptr<const Intersector> kernel;
  std::span<const Record> records; // of the kernel
  std::span<const Bucket> buckets;
  std::vector<std::vector<uint32_t>> lightSets; // indices into lights
  std::vector<LightSlot> lights;
  std::shared_ptr<const std::vector<Texture>> textures; // [0] is the missing one
  std::shared_ptr<const ShaderTable>
      shaders; // like the textures shared by snapshots between which they did not change
  RoleSlot camera, environment;
  ShaderSlot transport;                               // shaderClass null: the engine's own
  float eye[3] = {0, 0, 0}, viewAxis[3] = {0, 0, -1}; // render space; unit
  double origin[3] = {0, 0, 0};                       // of render space, in the world
  Emitters emitters; // path tracing: what sends out light besides the lights
  std::shared_ptr<const std::vector<ManyLights>>
      manyLights; // by light set; null: all lights are asked everywhere
  std::shared_ptr<const LightSources>
      lightSources;                // light tracing: null where it has nothing to do
  bool transparentShadows = false; // something transparent may stand before a light
  bool skyKnown = false,
       skyShines = false; // whether the environment was asked for light, and has some
  RenderHost host;
  edit::FrameSettingsT frame;
};

// Fills the host table's functions (render/surface/host.cpp).
void fillHost(RtsHost& host);

} // namespace openrt
