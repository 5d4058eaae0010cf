// openrt_cluster_master.cpp: a master whose workers have a key and attack it. They send anything in
// any order, most of it well formed, while the application commits, cancels and reads frames. The
// input is a sequence of events.
#include <map>

#include "backend/cluster/master/master.h"
#include "fuzz_input.h"
#include "render/frame/result_codec.h"
#include "scene/transports.h"

namespace {

using namespace openrt;
using namespace openrt::cluster;

constexpr Peer peers = 3;

struct Game {
  struct Side { // a worker
    bool there = false, full = false;
    uint64_t session = 0;
    std::vector<std::pair<Epoch, LeasedJob>> jobs; // jobs that it was given
  };
  FuzzInput in;
  double now = 1;
  Epoch epoch = 0;
  std::map<Peer, Side> sides;
  ArrayPtr array;
  std::vector<MasterOptions::Then> later; // merges queued for other threads
  std::unique_ptr<Master> master;

  explicit Game(std::span<const std::byte> bytes) : in(bytes) {
    auto made = std::make_shared<Array>(16);
    std::fill_n(made->data(), 16, std::byte(7));
    array = std::move(made);
    MasterOptions options;
    options.self.library = "fuzz";
    options.schedule.split = Split(in.below(4));
    options.local.log = [](int, const char*, void*) {};
    options.close = [this](Peer peer, const std::string&) { sides[peer] = {}; };
    options.background =
        options.results = [this](std::function<void()> heavy, MasterOptions::Then then) {
          heavy();
          later.push_back(std::move(then));
        };
    master = std::make_unique<Master>(
        options, [this](Peer peer, Frames&& frames) { return hear(peer, std::move(frames)); },
        nullptr);
  }

  // Receives a message of the master.
  bool hear(Peer peer, Frames&& frames) {
    Side& side = sides[peer];
    if (side.full) return false;
    Message m;
    if (!decode(std::move(frames), m).empty())
      __builtin_trap(); // the master must send only valid messages
    if (const auto* welcome = std::get_if<message::Welcome>(&m.body))
      side.session = welcome->session;
    if (const auto* jobs = std::get_if<message::Jobs>(&m.body))
      for (const LeasedJob& job : jobs->jobs) side.jobs.emplace_back(jobs->epoch, job);
    return true;
  }

  void commit() {
    auto commit = std::make_shared<Commit>();
    const auto add = [&](auto&& edit) {
      commit->edits.edits.emplace_back(new edit::EditT)->any.Set(std::move(edit));
    };
    if (in.flip()) {
      edit::TextureT texture;
      texture.id = uint32_t(epoch + 1);
      texture.components = 4;
      texture.width = texture.height = 2;
      texture.texels = 10 + epoch;
      commit->arrays[texture.texels] = array;
      add(std::move(texture));
    }
    edit::FrameSettingsT frame;
    constexpr uint32_t channels[] = {RT_RGBA, RT_RGBA | RT_VARIANCE, RT_RGBA | RT_ERROR,
                                     RT_RGBA | RT_DEPTH | RT_POSITION | RT_NAME | RT_NORMAL |
                                         RT_ALBEDO | RT_ERROR};
    constexpr uint32_t samples[] = {1, 4, 40, 128};
    frame.width = 7;
    frame.height = 5;
    frame.tile = 4;
    frame.depth = 2;
    frame.channels = channels[in.below(4)];
    frame.samples = samples[in.below(4)];
    frame.transport = uint8_t(in.below(std::size(transports)));
    frame.progressive = in.flip();
    if (in.flip()) frame.targetError = 0.1f;
    add(std::move(frame));
    commit->edits.render = true;
    master->commit(++epoch, std::move(commit), true, now);
  }

  // Returns a result, usually of the right size, with arbitrary numbers.
  std::vector<std::byte> made(Epoch of, const Job& job) {
    const Master::FrameState state = master->frame(of);
    if (!state.work || in.below(8) == 0) return in.bytes(400);
    const edit::FrameSettingsT& frame = state.prepared.frame;
    JobResult result;
    result.ledger.clipped = in.real();
    if (job.kind == Job::Kind::light) {
      result.light.assign(size_t(frame.width) * frame.height * 3, float(in.real()));
      return encodeResult(frame, job, result);
    }
    if (job.number >= state.work->tiles()) return in.bytes(400);
    startSums(result.sums, state.work->tile(job.number).pixels(), requiredSums(frame));
    const double a = in.real(), b = in.real(), c = in.real();
    for (PixelSums& s : result.sums)
      for (size_t k = 0; k < 3; k++) {
        s.rgba[k] = a;
        s.first[k] = b;
        s.delta[k] = c;
        s.delta2[k] = a;
        s.closed[k] = a;
        s.closed2[k] = b;
        s.closed3[k] = c;
        s.closed4[k] = a;
        s.grey[k] = b;
        s.largest[k] = float(c);
        s.random = true;
      }
    for (PixelSums& s : result.sums) {
      std::ranges::fill(s.firstValues, float(a));
      std::ranges::fill(s.valueSums, b);
    }
    result.sums[0].rgba[0] = b;
    result.sums[0].delta[0] = a; // not all pixels equal
    std::vector<std::byte> bytes = encodeResult(frame, job, result);
    if (in.below(8) == 0 && !bytes.empty())
      bytes[in.raw<uint16_t>() % bytes.size()] = std::byte(in.byte());
    return bytes;
  }

  message::Body anything(Side& side) {
    const Epoch of = in.number();
    switch (in.below(13)) {
    case 12: {
      message::Got got;
      for (size_t i = in.below(4); i > 0; i--)
        got.arrays.push_back(hashOf({array->data(), array->size()}));
      got.failed = in.flip();
      got.kept = in.flip();
      return got;
    }
    case 0: {
      message::Hello hello;
      hello.share = uint16_t(in.below(3));
      hello.library = "fuzz";
      hello.host = std::string(in.below(200), 'h');
      hello.threads = uint32_t(in.number());
      return hello;
    }
    case 1: {
      message::Need need{.epoch = of};
      for (size_t i = in.below(4); i > 0; i--)
        need.arrays.push_back(in.flip() ? hashOf({array->data(), array->size()})
                                        : Hash{in.number(), 0});
      return need;
    }
    case 2: {
      message::Ready ready{
          of, {in.byte() < 250, in.flip()}, uint8_t(in.below(std::size(transports))), {}};
      ready.stats.scene.triangles = in.below(8) == 0;
      return ready;
    }
    case 3: return message::Failed{.epoch = of, .why = "why"};
    case 4: return message::Log{.level = 2, .text = "line"};
    case 5: return message::Drop{.epoch = of};
    case 6: return message::Scene{of, in.flip(), in.flip(), {}, {}, in.bytes(100)};
    default: break;
    }
    message::Result result;
    Job job;
    if (side.jobs.empty() || in.byte() > 250) {
      result.epoch = of;
      result.lease = in.number();
    } else {
      const auto& [given, leased] = side.jobs[in.below(side.jobs.size())];
      result.epoch = given;
      result.lease = leased.lease;
      job = leased.job;
    }
    result.seconds = in.real();
    result.camera = in.number();
    if (in.below(8) == 0)
      result.faults.push_back(
          {.name = "A", .library = "b", .kind = in.byte(), .hits = in.number()});
    result.bytes = made(result.epoch, job);
    return result;
  }

  void say(Peer peer, Side& side) {
    if (in.below(16) == 0) return master->message(peer, {in.bytes(300), in.bytes(300)}, now);
    const bool known = in.byte() < 250; // whether to use its own session
    master->message(peer, encode(known ? side.session : in.number(), anything(side)), now);
  }

  void step() {
    const auto peer = Peer(1 + in.below(peers));
    Side& side = sides[peer];
    switch (in.below(16)) {
    case 0:
      if (epoch < 20) commit();
      break;
    case 1: master->cancel(in.number(), now); break;
    case 2:
      side = {};
      master->left(peer, "gone", now);
      break;
    case 3: side.full = !side.full; break;
    case 4: now += in.below(200) * 0.05; break;
    case 5:
      if (!later.empty()) {
        const MasterOptions::Then then = std::move(later.back());
        later.pop_back();
        then(now);
      }
      break;
    case 6: look(1 + in.below(20)); break;
    default:
      if (!side.there) {
        side.there = true;
        master->joined(peer, "somewhere", now);
        message::Hello hello;
        hello.library = "fuzz";
        hello.threads = uint32_t(1 + in.below(4));
        master->message(peer, encode(0, std::move(hello)), now);
      } else {
        say(peer, side);
      }
    }
    now += 0.001;
    master->advance(now);
  }

  void look(Epoch of) {
    const Master::FrameState state = master->frame(of);
    if (!state.work) return;
    std::vector<float> out(7 * 5 * 4);
    state.work->snapshot(RT_RGBA, out);
    if (!state.work->over()) return;
    state.work->film().read(RT_RGBA, out);
    RTstats stats{};
    stats.size = sizeof stats;
    state.work->describe(stats);
    if (state.over) master->forget(of);
  }
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size > 8192) return -1;
  Game game(std::as_bytes(std::span(data, size)));
  game.commit();
  while (!game.in.empty()) game.step();
  for (Epoch epoch = 1; epoch <= game.epoch; epoch++) game.look(epoch);
  game.master->totals();
  game.master->workers();
  return 0;
}
