// cluster_worker_rig.h: a worker's session for tests, which play the master. The executor only
// records its calls.
#pragma once

#include "backend/cluster/net/greeting.h"
#include "backend/cluster/worker/worker.h"
#include "backend/record/edits_bytes.h"
#include "unit/cluster_wires.h"

namespace openrt::cluster {

struct FakeMachine final : JobExecutor {
  std::vector<std::string> told;
  std::string isa;
  std::shared_ptr<const Commit> commit;
  std::vector<LeasedJob> jobs;
  void useInstructionSet(const std::string& name) override { isa = name; }
  void scene(Epoch epoch, std::shared_ptr<const Commit> c, bool whole, bool prepare) override {
    told.push_back("scene " + std::to_string(epoch) + (whole ? " whole" : "") +
                   (prepare ? " prepare" : ""));
    commit = std::move(c);
  }
  void prepare(Epoch epoch) override { told.push_back("prepare " + std::to_string(epoch)); }
  void work(Epoch epoch, std::span<const LeasedJob> all) override {
    told.push_back("work " + std::to_string(epoch) + " " + std::to_string(all.size()));
    jobs.assign(all.begin(), all.end());
  }
  void drop(Epoch epoch) override { told.push_back("drop " + std::to_string(epoch)); }
  std::vector<std::string> all() { return std::exchange(told, {}); }
};

struct Rig {
  FakeMachine machine;
  std::vector<std::pair<Peer, Message>> said;
  std::vector<std::pair<Peer, std::string>> closed, badOnes;
  std::vector<std::pair<std::string, message::ArrayName>> asked; // asked of other workers
  WorkerCounts counts;
  Worker worker;
  explicit Rig(const ShaderRegistry* shaders = nullptr, size_t cache = 1 << 20,
               ArrayFolder* folder = nullptr)
      : worker({.self = {.library = "test",
                         .isa = "avx2",
                         .threads = 2,
                         .isas = "avx2, sse2",
                         .share = uint16_t(folder ? 4711 : 0)},
                .shaders = shaders,
                .cacheBytes = cache,
                .folder = folder},
               {[this](Peer peer, Frames&& frames) {
                  decode(std::move(frames), said.emplace_back(peer, Message()).second);
                },
                [this](Peer peer, const std::string& why) { closed.emplace_back(peer, why); },
                [this](Peer peer, const std::string& why) { badOnes.emplace_back(peer, why); },
                [](double, double) {},
                [this](const std::string& address, std::vector<message::ArrayName> names) {
                  for (const message::ArrayName& name : names) asked.emplace_back(address, name);
                }},
               machine, counts) {}
  void tell(message::Body body, uint64_t session = 7, Peer peer = 1) {
    worker.message(peer, encode(session, std::move(body)), 0);
  }
  void greet(uint64_t session = 7, Peer peer = 1) {
    worker.joined(peer, "somewhere", 0);
    tell(usualWelcome(session), session, peer);
    said.clear();
  }
  // Returns the only message since the last call; it must be of this kind.
  template <class T> T answer() {
    EXPECT_EQ(said.size(), 1u);
    const T* found = said.empty() ? nullptr : std::get_if<T>(&said[0].second.body);
    EXPECT_NE(found, nullptr);
    T result = found ? *found : T();
    said.clear();
    return result;
  }
};

inline Array& filled(Array& array, uint8_t value) {
  std::fill_n(array.data(), array.size(), std::byte(value));
  return array;
}

// A frame of 8 x 8 pixels and a texture, sent as an array.
struct TinyScene {
  std::shared_ptr<Array> texels;
  message::Scene message;
  explicit TinyScene(Epoch epoch, uint8_t value = 1, bool whole = true, uint32_t edge = 2)
      : texels(std::make_shared<Array>(4 * size_t(edge) * edge)) {
    filled(*texels, value);
    edit::EditsT edits;
    const auto add = [&](auto&& edit) {
      edits.edits.emplace_back(new edit::EditT)->any.Set(std::move(edit));
    };
    edit::FrameSettingsT frame;
    frame.width = frame.height = 8;
    frame.channels = RT_RGBA;
    frame.samples = 4;
    frame.depth = 2;
    add(std::move(frame));
    edit::TextureT texture;
    texture.id = 1;
    texture.components = 4;
    texture.width = texture.height = edge;
    texture.texels = 10;
    add(std::move(texture));
    edits.render = true;
    message = {epoch, whole, true, {{10, texels->size(), hash()}}, {}, packEdits(edits)};
  }
  Hash hash() const { return hashOf({texels->data(), texels->size()}); }
  message::Piece piece() const {
    const auto packed = packArray({texels->data(), texels->size()});
    return pieceOf(hash(), texels->size(), packed, 0);
  }
};

// One whose texture is large enough for folders and other workers.
struct LargeScene : TinyScene {
  explicit LargeScene(Epoch epoch) : TinyScene(epoch, 1, true, 64) {}
};

} // namespace openrt::cluster
