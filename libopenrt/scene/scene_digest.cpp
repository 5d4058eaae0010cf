// scene_digest.cpp: the digest. Each thing of the scene (an object, a light, a parameter ...) has
// the digest of its last edit, so that it does not matter how often it was edited. Their sum does
// not depend on the order in which a map holds them.
#include "scene/scene_digest.h"

#include <utility>

#include <xxhash.h>

namespace openrt {
namespace {

// Arrays have a kind of their own beside those of edits (edits.fbs).
constexpr uint64_t ofArrays = 255;
constexpr uint64_t keyOf(uint64_t kind, uint64_t id, uint64_t index) {
  return kind << 56 | (index & 0xffffff) << 32 | (id & 0xffffffff);
}

constexpr uint64_t keyOf(edit::Any kind, uint64_t id, uint64_t index = 0) {
  return keyOf(uint64_t(kind), id, index);
}

uint64_t join(uint64_t a, uint64_t b) {
  const uint64_t both[2] = {a, b};
  return XXH3_64bits(both, sizeof both);
}

uint64_t digestOf(const edit::EditT& edit) {
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(edit::Edit::Pack(builder, &edit));
  return XXH3_64bits(builder.GetBufferPointer(), builder.GetSize());
}

// Returns the id of the thing that an edit is about, and for a parameter its index.
std::pair<uint64_t, uint64_t> thingOf(const edit::AnyUnion& any) {
  switch (any.type) {
  case edit::Any::Texture: return {any.AsTexture()->id, 0};
  case edit::Any::ShaderClass: return {any.AsShaderClass()->id, 0};
  case edit::Any::Shader: return {any.AsShader()->id, 0};
  case edit::Any::Parameter: return {any.AsParameter()->shader, any.AsParameter()->index};
  case edit::Any::Object: return {any.AsObject()->id, 0};
  case edit::Any::Instance: return {any.AsInstance()->id, 0};
  case edit::Any::Light: return {any.AsLight()->id, 0};
  default: return {0, 0}; // there is one of each
  }
}

} // namespace

void SceneDigest::add(const Commit& commit) {
  for (const auto& [id, array] : commit.arrays)
    things_[keyOf(ofArrays, id, id >> 32)] = XXH3_64bits(array->data(), array->size());
  for (const auto& edit : commit.edits.edits) {
    const edit::AnyUnion& any = edit->any;
    switch (any.type) {
    case edit::Any::FrameSettings: break;
    case edit::Any::DeleteTexture:
      things_.erase(keyOf(edit::Any::Texture, any.AsDeleteTexture()->id));
      break;
    case edit::Any::DeleteObject:
      things_.erase(keyOf(edit::Any::Object, any.AsDeleteObject()->id));
      break;
    case edit::Any::DeleteInstance:
      things_.erase(keyOf(edit::Any::Instance, any.AsDeleteInstance()->id));
      break;
    case edit::Any::DeleteLight:
      things_.erase(keyOf(edit::Any::Light, any.AsDeleteLight()->id));
      break;
    case edit::Any::DeleteShader: {
      const uint64_t id = any.AsDeleteShader()->id;
      things_.erase(keyOf(edit::Any::Shader, id));
      std::erase_if(things_, [&](const auto& thing) {
        return thing.first >> 56 == uint64_t(edit::Any::Parameter) &&
               (thing.first & 0xffffffff) == id;
      });
      break;
    }
    default:
      const auto [id, index] = thingOf(any);
      things_[keyOf(any.type, id, index)] = digestOf(*edit);
      if (any.type == edit::Any::Camera) cameraShader_ = any.AsCamera()->shader;
    }
  }
}

SceneDigest::Value SceneDigest::value() const {
  Value out;
  for (const auto& [key, digest] : things_) {
    const auto kind = edit::Any(key >> 56);
    const bool camera = kind == edit::Any::Camera ||
                        (kind == edit::Any::Parameter && (key & 0xffffffff) == cameraShader_);
    (camera ? out.view : out.world) += join(key, digest);
  }
  return out;
}

} // namespace openrt
