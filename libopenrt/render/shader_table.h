// shader_table.h: the shaders of a scene with their parameter blocks, and the media that they have.
// The local backend builds it between frames; all render threads read it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "openrt/openrts.h"
#include "scene/scene.h"

namespace openrt {

class ShaderRegistry;

struct ShaderSlot {
  const RtsClass* shaderClass = nullptr;
  const void* params = nullptr;
  uint32_t traits = 0;
  uint16_t medium = 0; // 1 + index into ShaderTable::media(); 0: none
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
  // Returns the traits that any shader has had since the table was first made.
  uint32_t allTraits() const { return allTraits_; }
  // Returns whether more than one shader has a medium.
  bool severalBodies() const { return bodies_ > 1; }
  // Returns the slot of a light, camera or environment shader; shaderClass is null if the id is not
  // of that kind.
  ShaderSlot role(uint32_t shaderId, RtsKind kind) const;

 private:
  struct Pointed { // lists and strings that a parameter struct points to
    std::vector<std::vector<float>> lists;
    std::vector<std::unique_ptr<std::string>> strings;
  };
  struct Block { // the parameter struct
    std::unique_ptr<std::byte[]> bytes;
    std::unique_ptr<Pointed> pointed;   // most classes have neither lists nor strings
    const RtsClass* prepared = nullptr; // class whose `release` must be called
    Block() = default;
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    ~Block();
  };
  using Slots = IdTable<uint32_t>; // slot by shader id
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
  uint32_t allTraits_ = 0;
  uint32_t bodies_ = 0; // number of slots that have a medium
  std::shared_ptr<const Slots> slotOf_;
  uint32_t defaultShader_ = 0; // the shader that slot 0 takes its values from
};

} // namespace openrt
