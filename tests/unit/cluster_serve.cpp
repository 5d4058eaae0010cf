// cluster_serve.cpp: a complete worker in a thread of this process and a small master, connected by
// a real wire. Scenes, arrays, jobs and results are transferred, and the picture must equal the
// local backend's.
#include "backend/cluster/worker/serve.h"

#include <atomic>
#include <map>
#include <thread>

#include "backend/cluster/master/parcel.h"
#include "backend/cluster/worker/worker_core.h"
#include "render/frame/frame_work.h"
#include "render/frame/result_codec.h"
#include "unit/cluster_wires.h"
#include "unit/drawn_scene.h"

using namespace openrt;
using namespace openrt::cluster;
using Kind = Event::Kind;

namespace {

class Service {
 public:
  Service(const ShaderRegistry& shaders, WireOptions wire, bool once = false) {
    ServeOptions options;
    options.wire = std::move(wire);
    options.backend.threads = 2;
    options.backend.shaders = &shaders;
    options.once = once;
    service_ = std::make_unique<WorkerService>(options);
    thread_ = std::thread([this] {
      service_->run();
      ended = true;
    });
  }
  ~Service() {
    service_->stop();
    thread_.join();
  }
  std::string address() const { return service_->address(); }
  std::atomic<bool> ended{false};

 private:
  std::unique_ptr<WorkerService> service_;
  std::thread thread_;
};

// A master that sends one message at a time and waits for the answer.
struct Master {
  Wire wire;
  Packer packer;
  Peer peer = 0;
  uint64_t session;
  Epoch epoch = 0;
  Lease lease = 0;
  size_t pieces = 0;

  Master(const WireOptions& options, const ShaderRegistry& shaders, uint64_t s)
      : wire(options), packer(&shaders), session(s) {
    const auto hello = next<message::Hello>();
    EXPECT_EQ(hello.threads, 2u);
    say(message::Welcome{
        .protocol = protocolVersion, .session = session, .heartbeat = 0.1f, .silence = 60});
  }
  void say(message::Body&& body) { EXPECT_TRUE(wire.send(peer, encode(session, std::move(body)))); }
  // Returns the next message, which must be of this kind.
  template <class T> T next() {
    for (const double end = steadySeconds() + 120; steadySeconds() < end;) {
      Event event = wire.receive(0.1);
      if (event.kind == Kind::joined) peer = event.peer;
      EXPECT_NE(event.kind, Kind::left) << event.text;
      if (event.kind != Kind::message) continue;
      Message m = read(std::move(event));
      if (std::holds_alternative<message::Log>(m.body)) continue;
      if (T* body = std::get_if<T>(&m.body)) return std::move(*body);
      if (const auto* failed = std::get_if<message::Failed>(&m.body)) ADD_FAILURE() << failed->why;
      throw std::runtime_error("another message than expected: " + std::to_string(m.body.index()));
    }
    throw std::runtime_error("nothing comes");
  }
  void sendArrays(const Parcel& parcel, const message::Need& need) {
    for (const Hash& hash : need.arrays)
      for (const OfferPtr& offer : parcel.offers) {
        if (offer->hash != hash) continue;
        const auto packed = packArray({offer->array->data(), offer->array->size()});
        for (size_t at = 0; at < packed.size(); at += pieceBytes, pieces++)
          say(pieceOf(hash, offer->array->size(), packed, at));
      }
  }
  std::vector<float> picture(const std::shared_ptr<const Commit>& commit, bool whole) {
    const ParcelPtr parcel = packer.pack(commit);
    say(message::Scene{++epoch, whole, true, parcel->arrays, parcel->libraries, parcel->edits});
    const auto need = next<message::Need>();
    EXPECT_EQ(need.epoch, epoch);
    sendArrays(*parcel, need);
    const auto ready = next<message::Ready>();
    edit::FrameSettingsT settings;
    for (const auto& entry : commit->edits.edits)
      if (const auto* frame = entry->any.AsFrameSettings()) settings = last = *frame;
    settings = last;
    settings.transport = ready.transport;
    FrameWork work(settings, ready.facts, 2);
    std::map<Lease, Job> out;
    for (Job job;;) {
      message::Jobs jobs{.epoch = epoch};
      FrameWork::Next what = FrameWork::Next::job;
      while (out.size() < 8 && (what = work.next(job, 32)) == FrameWork::Next::job) {
        jobs.jobs.push_back({++lease, job});
        out[lease] = job;
      }
      if (!jobs.jobs.empty()) say(std::move(jobs));
      if (out.empty() && what == FrameWork::Next::over) break;
      const auto result = next<message::Result>();
      const Job& done = out.at(result.lease);
      JobResult r;
      EXPECT_TRUE(decodeResult(settings, done, work.tile(done.number), result.bytes, r));
      r.seconds = result.seconds;
      r.counters.camera = result.camera;
      EXPECT_TRUE(work.take(done, std::move(r)));
      out.erase(result.lease);
    }
    EXPECT_GT(work.counters().camera, 0u);
    std::vector<float> rgba(size_t(settings.width) * settings.height * 4);
    EXPECT_TRUE(work.film().read(RT_RGBA, rgba));
    return rgba;
  }
  edit::FrameSettingsT last;
};

class Serve : public testing::Test {
 protected:
  test::Commits commits = test::drawn([] {
    test::drawRoom();
    test::set({.samples = 64, .width = 40, .height = 30});
    rtRender();
    test::lookFrom(1, 1, 4);
    rtRender();
  });
  std::vector<float> expected(size_t count) {
    BackendOptions options;
    options.threads = 1;
    options.shaders = &shaders;
    const auto backend = makeLocalBackend(options);
    for (size_t i = 0; i < count; i++) backend->apply(commits[i]);
    backend->start();
    backend->wait();
    std::vector<float> rgba(40 * 30 * 4);
    EXPECT_TRUE(backend->read(RT_RGBA, rgba));
    return rgba;
  }
  ShaderRegistry shaders{shaderFolders("")};
};

WireOptions to(const std::string& address, const KeyRing& keys = {}) {
  return withLongTimeouts({{address}, "", keys});
}

} // namespace

TEST_F(Serve, picturesAreThoseOfTheLocalBackend) {
  const Service service(shaders, listening());
  Master master(to(service.address()), shaders, 42);
  EXPECT_EQ(master.picture(commits[0], true), expected(1));
  EXPECT_GT(master.pieces, 0u);
  EXPECT_EQ(master.picture(commits[1], false), expected(2));
}

TEST_F(Serve, theNextMasterDoesNotSendArraysAgain) {
  const Service service(shaders, listening());
  {
    Master first(to(service.address()), shaders, 42);
    first.picture(commits[0], true);
  }
  Master second(to(service.address()), shaders, 43);
  EXPECT_EQ(second.picture(commits[0], true), expected(1));
  EXPECT_EQ(second.pieces, 0u);
}

TEST_F(Serve, aWorkerThatCallsWithKeysAndEndsWithItsMaster) {
  const Folder folder;
  const KeyRing keys = freshKeys(folder, "key");
  std::string address;
  {
    const Wire first(listening(keys)); // finds a free port
    address = first.address();
  }
  const Service service(shaders, to(address, keys), true);
  {
    Master master(withLongTimeouts({{}, address, keys}), shaders, 42);
    EXPECT_EQ(master.picture(commits[0], true), expected(1));
  }
  for (const double end = steadySeconds() + 60; !service.ended && steadySeconds() < end;)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(service.ended);
}
