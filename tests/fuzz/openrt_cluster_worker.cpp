// openrt_cluster_worker.cpp: a worker whose master has a key and attacks it: scenes, chunks of
// arrays and jobs in any order, most of them well formed, while the executor answers or fails. The
// input is a sequence of events.
#include <deque>

#include "backend/cluster/net/greeting.h"
#include "backend/cluster/worker/worker.h"
#include "backend/record/edits_bytes.h"
#include "fuzz_input.h"
#include "render/frame/result_codec.h"

namespace {

using namespace openrt;
using namespace openrt::cluster;

constexpr size_t arrays = 4;

std::shared_ptr<Array> arrayOf(size_t i) {
  auto array = std::make_shared<Array>(i * i * 8);
  std::fill_n(array->data(), array->size(), std::byte(i));
  return array;
}

struct Game final : JobExecutor {
  FuzzInput in;
  edit::FrameSettingsT frame;
  // Frames that the executor was asked to prepare.
  std::deque<std::pair<Epoch, edit::FrameSettingsT>> toPrepare;
  std::deque<std::pair<Epoch, LeasedJob>> jobs;
  uint64_t session = 0;
  Peer peer = 0;
  WorkerCounts counts;
  std::deque<Hash> fetching; // arrays asked of other workers
  Worker worker;

  explicit Game(std::span<const std::byte> bytes)
      : in(bytes),
        worker({.self = {.library = "fuzz", .threads = 2, .share = 1}, .cacheBytes = 256},
               {[](Peer, Frames&& frames) {
                  Message m;
                  if (!decode(std::move(frames), m).empty())
                    __builtin_trap(); // the worker must send only valid messages
                },
                [this](Peer, const std::string&) { peer = 0; }, [](Peer, const std::string&) {},
                [](double, double) {},
                [this](const std::string&, std::vector<message::ArrayName> names) {
                  for (const auto& name : names) fetching.push_back(name.hash);
                }},
               *this, counts) {}

  void useInstructionSet(const std::string&) override {}
  void scene(Epoch epoch, std::shared_ptr<const Commit> commit, bool, bool prepare) override {
    for (const auto& entry : commit->edits.edits)
      if (const auto* settings = entry->any.AsFrameSettings()) frame = *settings;
    if (prepare) toPrepare.emplace_back(epoch, frame);
  }
  void prepare(Epoch epoch) override { toPrepare.emplace_back(epoch, frame); }
  void work(Epoch epoch, std::span<const LeasedJob> more) override {
    for (const LeasedJob& job : more) jobs.emplace_back(epoch, job);
  }
  void drop(Epoch epoch) override {
    std::erase_if(jobs, [&](const auto& job) { return job.first <= epoch; });
  }

  std::vector<std::byte> edits(message::Scene& scene) {
    if (in.below(8) == 0) return in.bytes(1000);
    edit::EditsT all;
    const auto add = [&](auto&& edit) {
      all.edits.emplace_back(new edit::EditT)->any.Set(std::move(edit));
    };
    if (in.byte() < 250) {
      edit::FrameSettingsT settings;
      settings.width = uint32_t(1 + in.number());
      settings.height = uint32_t(1 + in.number());
      settings.channels = RT_RGBA | RT_DEPTH;
      settings.samples = uint32_t(1 + in.number());
      settings.depth = 2;
      add(std::move(settings));
    }
    for (size_t i = in.below(4); i > 0; i--) {
      edit::TextureT texture;
      texture.id = uint32_t(in.number());
      texture.components = 4;
      texture.width = texture.height = uint32_t(in.below(arrays));
      texture.texels = 1 + in.below(arrays);
      if (in.byte() < 250) scene.arrays.push_back(name(texture.texels, in.below(arrays)));
      add(std::move(texture));
    }
    all.render = true;
    return packEdits(all);
  }
  message::ArrayName name(ArrayId id, size_t i) {
    const auto array = arrayOf(i);
    if (in.byte() > 250) return {id, in.number(), {in.number(), 0}};
    return {id, array->size(), hashOf({array->data(), array->size()})};
  }

  message::Body anything() {
    const Epoch of = in.number();
    switch (in.below(11)) {
    case 10: {
      message::Source m{.address = "somewhere:1"};
      for (size_t i = in.below(4); i > 0; i--) {
        const auto array = arrayOf(in.below(arrays));
        m.arrays.push_back({0, array->size(), hashOf({array->data(), array->size()})});
      }
      return m;
    }
    case 0: {
      session = in.number();
      return message::Welcome{.protocol = protocolVersion + (in.byte() > 250),
                              .session = session,
                              .heartbeat = 0.1f,
                              .silence = 0.5f};
    }
    case 1: return message::Prepare{.epoch = of};
    case 2: return message::Drop{.epoch = of};
    case 3: return message::Need{.epoch = of};
    case 4:
    case 5: {
      message::Jobs m{.epoch = of};
      for (size_t i = in.below(5); i > 0; i--) {
        LeasedJob job{in.number(), {}};
        job.job.kind = Job::Kind(in.below(2));
        job.job.number = uint32_t(in.number());
        job.job.first = uint32_t(in.number());
        job.job.count = uint32_t(in.number());
        job.job.replicates.shift = in.byte() & 31;
        m.jobs.push_back(job);
      }
      return m;
    }
    case 6:
    case 7: {
      const auto array = arrayOf(in.below(arrays));
      const Hash hash = hashOf({array->data(), array->size()});
      auto packed = packArray({array->data(), array->size()});
      if (in.byte() > 240 && !packed.empty())
        packed[in.below(packed.size())] = std::byte(in.byte());
      message::Piece piece = pieceOf(hash, array->size(), packed, 0);
      if (in.byte() > 250) piece.bytes = in.number();
      if (in.byte() > 250) piece.stored = in.number();
      return piece;
    }
    default: {
      message::Scene scene{of, in.flip(), in.flip(), {}, {}, {}};
      scene.edits = edits(scene);
      if (in.byte() > 250) scene.libraries.push_back({.name = "../none"});
      return scene;
    }
    }
  }

  void answer() {
    if (jobs.empty() || in.flip()) {
      if (toPrepare.empty()) return;
      const auto [epoch, settings] = toPrepare.front();
      toPrepare.pop_front();
      Prepared prepared;
      prepared.facts.camera = in.flip();
      prepared.facts.lamps = in.flip();
      prepared.frame = settings;
      prepared.frame.transport = RT_TRANSPORT_DIRECT;
      if (in.byte() > 230) return worker.failed(epoch, "why");
      return worker.ready(epoch, prepared);
    }
    const auto [epoch, job] = jobs.front();
    jobs.pop_front();
    JobResult result;
    if (job.job.kind == Job::Kind::samples) result.sums.resize(4);
    worker.done(epoch, job, std::move(result));
  }

  void step() {
    switch (in.below(16)) {
    case 0: worker.joined(peer = Peer(1 + in.below(3)), "somewhere", 0); break;
    case 1:
      if (in.byte() > 128) worker.left(peer, "gone", 0);
      break;
    case 2: worker.advance(in.below(10)); break;
    case 3: return worker.log(2, "line");
    case 9: {
      if (fetching.empty()) break;
      const Hash hash = fetching.front();
      fetching.pop_front();
      const auto array = arrayOf(in.below(arrays));
      const bool good = hashOf({array->data(), array->size()}) == hash;
      return worker.fetched(hash, good ? array : nullptr);
    }
    case 4:
    case 5:
    case 6:
    case 7: return answer();
    case 8: return worker.message(peer, {in.bytes(300), in.bytes(300)}, 0);
    default: break;
    }
    if (!worker.serving()) {
      worker.joined(peer = 1, "somewhere", 0);
      session = 1 + in.below(3);
      worker.message(peer, encode(session, usualWelcome(session)), 0);
    }
    message::Body body = anything();
    worker.message(peer, encode(session, std::move(body)), 0);
  }
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size > 8192) return -1;
  Game game(std::as_bytes(std::span(data, size)));
  while (!game.in.empty()) game.step();
  return 0;
}
