#include "scene/scene_digest.h"

#include <vector>

#include <xxhash.h>

namespace openrt {
namespace {

uint64_t join(uint64_t a, uint64_t b) {
  const uint64_t both[2] = {a, b};
  return XXH3_64bits(both, sizeof both);
}

uint64_t digestOf(const edit::EditT& edit) {
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(edit::Edit::Pack(builder, &edit));
  return XXH3_64bits(builder.GetBufferPointer(), builder.GetSize());
}

} // namespace

void SceneDigest::add(const Commit& commit) {
  for (const auto& [id, array] : commit.arrays)
    arrays_[id] = XXH3_64bits(array->data(), array->size());
  for (const auto& edit : commit.edits.edits) {
    switch (edit->any.type) {
    case edit::Any_FrameSettings: break;
    case edit::Any_Camera:
      cameraShader_ = edit->any.AsCamera()->shader;
      camera_ = digestOf(*edit);
      break;
    case edit::Any_Parameter: { // a later value of the same parameter follows the earlier one
      uint64_t& shader = shaders_[edit->any.AsParameter()->shader];
      shader = join(shader, digestOf(*edit));
      break;
    }
    default: world_ = join(world_, digestOf(*edit));
    }
  }
}

SceneDigest::Value SceneDigest::value() const {
  Value out{world_, camera_};
  // Sums do not depend on the order in which a map holds its entries.
  uint64_t shaders = 0, arrays = 0;
  for (const auto& [id, digest] : shaders_)
    if (id == cameraShader_)
      out.view = join(out.view, digest);
    else
      shaders += join(id, digest);
  for (const auto& [id, digest] : arrays_) arrays += join(id, digest);
  out.world = join(join(out.world, shaders), arrays);
  return out;
}

} // namespace openrt
