// shader_table.cpp: builds the parameter blocks of shaders: the class's defaults, then the values
// of the scene.
#include "render/shader_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "render/media.h"
#include "render/render_scene.h"
#include "shading/parameters.h"
#include "shading/registry.h"
#include "shading/running.h"

namespace openrt {
namespace {

// Returns a host for `release`, which may be called when no frame exists any more. All its
// functions are set, but it has no scene.
const RtsHost& idleHost() {
  static const RenderHost host = [] {
    RenderHost h;
    fillHost(h);
    return h;
  }();
  return host;
}

} // namespace

ShaderTable::Block::~Block() {
  if (!prepared || !prepared->release) return;
  const RunningShader running(*prepared);
  prepared->release(&idleHost(), bytes.get());
}

ShaderTable::ShaderTable(const Scene& scene, const ShaderRegistry& registry,
                         const std::map<uint32_t, uint32_t>& textureIndex, const RtsHost& host) {
  slots_.resize(1 + scene.shaders.size());
  blocks_.resize(slots_.size());
  classes_.resize(slots_.size());
  const auto fallback = scene.shaders.find(scene.defaultShader);
  const RtsClass* base = nullptr;
  if (fallback != scene.shaders.end()) {
    const auto name = scene.classes.find(fallback->second.shaderClass);
    if (name != scene.classes.end()) base = &registry.find(name->second.name, name->second.library);
    if (base && base->kind != RTS_SURFACE) base = nullptr;
  }
  if (base && make(0, *base, &fallback->second, textureIndex, host))
    defaultShader_ = scene.defaultShader;
  else
    make(0, registry.find("VRML97", ""), nullptr, textureIndex, host);
  uint32_t slot = 1;
  auto slots = std::make_shared<Slots>();
  for (const auto& [id, values] : scene.shaders) {
    const auto name = scene.classes.find(values.shaderClass);
    if (name == scene.classes.end()) continue;
    slots->try_emplace(id, slot);
    make(slot++, registry.find(name->second.name, name->second.library), &values, textureIndex,
         host);
  }
  slots_.resize(slot);
  blocks_.resize(slot);
  classes_.resize(slot);
  slotOf_ = std::move(slots);
}

ShaderTable::ShaderTable(const ShaderTable& before, const std::vector<uint32_t>& changed,
                         const Scene& scene, const std::map<uint32_t, uint32_t>& textureIndex,
                         const RtsHost& host)
    : slots_(before.slots_), blocks_(before.blocks_), classes_(before.classes_),
      media_(before.media_), users_(before.users_), numbers_(before.numbers_),
      allTraits_(before.allTraits_), bodies_(before.bodies_), slotOf_(before.slotOf_),
      defaultShader_(before.defaultShader_) {
  for (uint32_t id : changed) {
    const auto slot = slotOf_->find(id);
    const auto values = scene.shaders.find(id);
    if (slot == slotOf_->end() || values == scene.shaders.end()) continue;
    make(slot->second, *classes_[slot->second], &values->second, textureIndex, host);
    if (id == defaultShader_) make(0, *classes_[0], &values->second, textureIndex, host);
  }
}

uint32_t ShaderTable::slotOf(uint32_t shaderId) const {
  const auto found = slotOf_->find(shaderId);
  return found != slotOf_->end() && slots_[found->second].shaderClass->kind == RTS_SURFACE
             ? found->second
             : 0;
}

ShaderSlot ShaderTable::role(uint32_t shaderId, RtsKind kind) const {
  const auto found = slotOf_->find(shaderId);
  if (found == slotOf_->end() || slots_[found->second].shaderClass->kind != kind) return {};
  return slots_[found->second];
}

bool ShaderTable::extends(const ShaderTable& other) const {
  const auto same = [](const ShaderSlot& a, const ShaderSlot& b) {
    return a.shaderClass == b.shaderClass && a.traits == b.traits;
  };
  if (slotOf_ == other.slotOf_)
    return std::equal(slots_.begin(), slots_.end(), other.slots_.begin(), same);
  if (!same(slots_[0], other.slots_[0])) return false;
  for (const auto& [id, slot] : *other.slotOf_) {
    const auto found = slotOf_->find(id);
    if (found == slotOf_->end() || found->second != slot || !same(slots_[slot], other.slots_[slot]))
      return false;
  }
  return true;
}

// Makes the parameter block of a slot. Returns false if the class refuses the values: the default
// shader then replaces a surface, and nothing replaces other kinds.
bool ShaderTable::make(uint32_t number, const RtsClass& shaderClass, const ShaderValues* values,
                       const std::map<uint32_t, uint32_t>& textureIndex, const RtsHost& host) {
  const auto made = std::make_shared<Block>();
  Block& block = *made;
  block.bytes = std::make_unique<std::byte[]>(shaderClass.paramSize ? shaderClass.paramSize : 1);
  for (uint32_t i = 0; i < shaderClass.paramCount; i++) {
    const RtsParam& param = shaderClass.params[i];
    std::byte* at = block.bytes.get() + param.offset;
    std::optional<ParameterValue> value;
    if (values) value = values->parameters.find(i);
    if (const size_t n = parameterFloats(param.type)) {
      float numbers[16];
      std::memcpy(numbers, param.defaultValue, sizeof numbers);
      if (value)
        for (size_t k = 0; k < n && k < value->floats.size(); k++) numbers[k] = value->floats[k];
      std::memcpy(at, numbers, n * sizeof(float));
    } else if (param.type == RTS_INT) {
      const int32_t number = value ? value->integer : int32_t(param.defaultValue[0]);
      std::memcpy(at, &number, sizeof number);
    } else if (param.type == RTS_FLOATS) {
      if (!block.pointed) block.pointed = std::make_unique<Pointed>();
      std::vector<float>& floats = block.pointed->lists.emplace_back();
      if (value) floats.assign(value->floats.begin(), value->floats.end());
      const RtsFloats list{floats.data(), uint32_t(floats.size())};
      std::memcpy(at, &list, sizeof list);
    } else if (param.type == RTS_STRING) {
      if (!block.pointed) block.pointed = std::make_unique<Pointed>();
      auto& strings = block.pointed->strings;
      strings.push_back(std::make_unique<std::string>(value ? value->text : std::string_view()));
      const char* text = strings.back()->c_str();
      std::memcpy(at, &text, sizeof text);
    } else if (param.type == RTS_TEXTURE) {
      RtsTexture texture = 0;
      const uint32_t handle = value ? value->texture : 0;
      if (const auto found = textureIndex.find(handle); value && found != textureIndex.end())
        texture = found->second;
      std::memcpy(at, &texture, sizeof texture);
    }
  }
  ShaderSlot slot{&shaderClass, block.bytes.get(), 0, slots_[number].medium};
  classes_[number] = &shaderClass;
  {
    const RunningShader running(shaderClass);
    if (shaderClass.prepare) {
      block.prepared = &shaderClass;
      if (const char* message = shaderClass.prepare(&host, block.bytes.get())) {
        if (host.log)
          host.log(&host, 3, (std::string("shader ") + shaderClass.name + ": " + message).c_str());
        if (number != 0) {
          countUse(slots_[number].medium, false);
          slots_[number] = slots_[0];
          blocks_[number] = blocks_[0];
          countUse(slots_[number].medium, true);
        }
        return false;
      }
    }
    if (shaderClass.traits) slot.traits = shaderClass.traits(&host, slot.params);
    allTraits_ |= slot.traits;
    if (shaderClass.medium) setMedium(slot, host);
  }
  slots_[number] = slot;
  blocks_[number] = made;
  return true;
}

namespace {

// Returns whether the medium does not scatter, or with coefficients and a phase function that can
// be sampled.
bool scattersSoundly(const RtsMedium& medium) {
  constexpr float most = 1e30f;
  bool any = false, sound = std::fabs(medium.anisotropy) < 1;
  for (int k = 0; k < 3; k++) {
    any |= medium.scattering[k] != 0;
    sound &= medium.scattering[k] >= 0 && medium.scattering[k] <= most &&
             medium.absorption[k] >= 0 && medium.absorption[k] <= most;
  }
  return !any || sound;
}

} // namespace

// Stores the slot's medium; it keeps its number when its values change, unless it shares it or the
// values are those of another one. A shader whose values are out of range has no medium.
void ShaderTable::setMedium(ShaderSlot& slot, const RtsHost& host) {
  RtsMedium medium{};
  bool good = slot.shaderClass->medium(&host, slot.params, &medium) != 0;
  for (int k = 0; k < 3; k++)
    good = good && medium.index[k] > 0 && std::isfinite(medium.index[k]) &&
           std::isfinite(medium.absorption[k]);
  if (good && !scattersSoundly(medium)) {
    if (host.log)
      host.log(&host, 2,
               (std::string("shader ") + slot.shaderClass->name +
                ": a medium that scatters needs absorption >= 0, scattering from 0 to 1e30 and an "
                "anisotropy between -1 and 1; this one is left without scattering")
                   .c_str());
    std::fill_n(medium.scattering, 3, 0.0f);
  }
  const uint16_t before = std::exchange(slot.medium, uint16_t(0));
  countUse(before, false);
  const bool alone = before && users_[before - 1] == 0;
  if (alone) std::erase_if(numbers_, [&](const auto& entry) { return entry.second == before; });
  if (!good) return;
  const std::string key(reinterpret_cast<const char*>(&medium), sizeof medium);
  if (const auto same = numbers_.find(key); same != numbers_.end() && !scatters(medium)) {
    slot.medium = same->second;
  } else if (alone) {
    slot.medium = before;
  } else if (media_.size() < 0xffff) {
    media_.emplace_back();
    users_.push_back(0);
    slot.medium = uint16_t(media_.size());
  } else {
    return;
  }
  media_[slot.medium - 1] = medium;
  if (!scatters(medium)) numbers_[key] = slot.medium;
  countUse(slot.medium, true);
}

// Counts one slot more or less that has a medium; 0: none.
void ShaderTable::countUse(uint16_t medium, bool more) {
  if (!medium) return;
  users_[medium - 1] += more ? 1 : -1;
  bodies_ += more ? 1 : -1;
}

} // namespace openrt
