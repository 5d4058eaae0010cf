// cluster_useless.cpp: every way in which a worker can be useless, against a complete master over
// real wires. By docs/cluster.md no picture waits longer than 10 seconds without progress. The
// pictures must be those of a single thread.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include <arpa/inet.h>
#include <sys/socket.h>

#include "backend/backend.h"
#include "backend/cluster/net/greeting.h"
#include "backend/cluster/worker/worker_core.h"
#include "unit/cluster_wires.h"
#include "unit/drawn_scene.h"

using namespace openrt;
using namespace openrt::cluster;

namespace {

constexpr double promised = 10; // seconds without progress (docs/cluster.md)
constexpr double slack = 15;    // extra seconds for a busy machine
#ifdef __SANITIZE_THREAD__
constexpr double slowness = 10; // how much longer the pictures themselves take
#else
constexpr double slowness = 1;
#endif
constexpr uint32_t frames = 2;

enum class Misbehaviour {
  nobody,        // nothing listens at the address
  deaf,          // the system accepts the connection, but the process is stopped and does not read
  mute,          // connected, but sends no Hello
  otherVersion,  // another version of the program
  otherProtocol, // another version of the protocol
  otherChip,     // a machine with another instruction set
  takesNoScene,  // sends heartbeats, but never says which arrays of a scene it needs
  neverReady,    // has all arrays, but never sends Ready
  refuses,       // cannot prepare the scene, because a shader library differs
  refusesLater,  // sends Ready, then that it cannot prepare the scene
  beatsOnly,     // ready, takes jobs, sends heartbeats and never a result
  dies,          // ready, crashes at the first jobs, and joins again
  comesAndGoes,  // joins and leaves several times a second
  answersNonsense, // sends bytes that are not a result
  answersOthers,   // sends results of jobs that it was not given
  sendsNonsense,   // sends messages that only a master sends
  sendsNoise,      // sends bytes that are no messages
  readyForEver,    // sends Ready again and again
  liesAboutScene,  // reports a different number of triangles
};
const std::map<Misbehaviour, const char*> names = {
    {Misbehaviour::nobody, "nobody"},
    {Misbehaviour::deaf, "deaf"},
    {Misbehaviour::mute, "mute"},
    {Misbehaviour::otherVersion, "otherVersion"},
    {Misbehaviour::otherProtocol, "otherProtocol"},
    {Misbehaviour::otherChip, "otherChip"},
    {Misbehaviour::takesNoScene, "takesNoScene"},
    {Misbehaviour::neverReady, "neverReady"},
    {Misbehaviour::refuses, "refuses"},
    {Misbehaviour::refusesLater, "refusesLater"},
    {Misbehaviour::beatsOnly, "beatsOnly"},
    {Misbehaviour::dies, "dies"},
    {Misbehaviour::comesAndGoes, "comesAndGoes"},
    {Misbehaviour::answersNonsense, "answersNonsense"},
    {Misbehaviour::answersOthers, "answersOthers"},
    {Misbehaviour::sendsNonsense, "sendsNonsense"},
    {Misbehaviour::sendsNoise, "sendsNoise"},
    {Misbehaviour::readyForEver, "readyForEver"},
    {Misbehaviour::liesAboutScene, "liesAboutScene"}};

// The two pictures of all tests, and the Ready messages of a worker that can prepare them.
struct Pictures final : WorkerSink {
  Pictures() {
    BackendOptions options;
    options.threads = 1;
    options.shaders = &shaders;
    {
      const auto backend = makeLocalBackend(options);
      RTstats stats{};
      stats.size = sizeof stats;
      backend->stats(stats);
      self = identity(stats);
      self.threads = 2;
      for (uint32_t i = 0; i < frames; i++) {
        backend->apply(commits[i]);
        backend->start();
        backend->wait();
        expected.push_back(read(*backend));
      }
    }
    WorkerCore core(options, *this);
    for (uint32_t i = 0; i < frames; i++) core.scene(i + 1, commits[i], i == 0, true);
    std::unique_lock lock(mutex);
    EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(60),
                                 [this] { return prepared.size() == frames; }));
  }
  static std::vector<float> read(const Backend& backend) {
    std::vector<float> rgba(40 * 30 * 4);
    EXPECT_TRUE(backend.read(RT_RGBA, rgba));
    return rgba;
  }
  void ready(Epoch epoch, const Prepared& p) override {
    const std::lock_guard lock(mutex);
    prepared[epoch] = p;
    changed.notify_all();
  }
  void failed(Epoch, const std::string& why) override { ADD_FAILURE() << why; }
  void done(Epoch, const LeasedJob&, JobResult&&) override {}

  ShaderRegistry shaders{shaderFolders("")};
  test::Commits commits = test::drawn([] {
    test::drawRoom();
    test::set({.samples = 64, .width = 40, .height = 30});
    rtRender();
    test::lookFrom(1, 1, 4);
    rtRender();
  });
  message::Hello self;
  std::vector<std::vector<float>> expected;
  std::mutex mutex;
  std::condition_variable changed;
  std::map<Epoch, Prepared> prepared;
};

const Pictures& pictures() {
  static const Pictures all;
  return all;
}

// A useless worker in a thread of its own.
class UselessWorker {
 public:
  explicit UselessWorker(Misbehaviour way) : way_(way) {
    if (way == Misbehaviour::deaf || way == Misbehaviour::nobody) {
      socket_ = socket(AF_INET, SOCK_STREAM, 0);
      sockaddr_in where{};
      where.sin_family = AF_INET;
      where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      socklen_t size = sizeof where;
      EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&where), size), 0);
      if (way == Misbehaviour::deaf) { EXPECT_EQ(listen(socket_, 16), 0); }
      EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&where), &size), 0);
      address_ = "127.0.0.1:" + std::to_string(ntohs(where.sin_port));
      return;
    }
    wire_.emplace(WireOptions{{}, "127.0.0.1:0", {}});
    address_ = wire_->address();
    thread_ = std::thread([this] { run(); });
  }
  ~UselessWorker() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    if (socket_ >= 0) close(socket_);
  }
  const std::string& address() const { return address_; }

 private:
  void run() {
    while (!stop_) {
      if (!wire_) { // the port becomes free a moment after the previous worker has ended
        try {
          wire_.emplace(WireOptions{{}, address_, {}});
        } catch (const std::exception&) {
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
          continue;
        }
      }
      Event event = wire_->receive(0.02);
      if (event.kind == Event::Kind::joined) {
        peer_ = event.peer;
        session_ = 0;
        joined_ = steadySeconds();
        greet();
      }
      if (event.kind == Event::Kind::message) hear(read(std::move(event)));
      if (session_ != 0 && way_ == Misbehaviour::comesAndGoes && steadySeconds() > joined_ + 0.2)
        die();
      if (session_ != 0 && way_ == Misbehaviour::readyForEver && epoch_ > 0 &&
          steadySeconds() > told_ + 0.1)
        ready();
    }
  }
  void greet() {
    message::Hello hello = pictures().self;
    if (way_ == Misbehaviour::otherVersion) hello.library = "0.0.1";
    if (way_ == Misbehaviour::otherProtocol) hello.protocol++;
    if (way_ == Misbehaviour::otherChip) hello.isa = hello.isas = "of its own";
    if (way_ != Misbehaviour::mute) say(std::move(hello));
  }
  void hear(Message&& m) {
    if (const auto* welcome = std::get_if<message::Welcome>(&m.body)) {
      session_ = welcome->session;
      if (way_ == Misbehaviour::sendsNonsense)
        for (int i = 0; i < 3; i++) say(message::Drop{.epoch = 1});
      if (way_ == Misbehaviour::sendsNoise) wire_->send(peer_, Frames(2, someBytes(100)));
    }
    if (const auto* scene = std::get_if<message::Scene>(&m.body)) {
      epoch_ = scene->epoch;
      if (way_ == Misbehaviour::takesNoScene) return;
      message::Need need{.epoch = scene->epoch};
      for (const auto& array : scene->arrays) need.arrays.push_back(array.hash);
      say(std::move(need));
      if (way_ == Misbehaviour::refuses)
        return say(message::Failed{.epoch = scene->epoch,
                                   .why = "shader library vrml97 differs from the master's"});
      if (scene->prepare && way_ != Misbehaviour::neverReady) ready();
    }
    if (const auto* prepare = std::get_if<message::Prepare>(&m.body)) {
      epoch_ = prepare->epoch;
      ready();
    }
    if (const auto* jobs = std::get_if<message::Jobs>(&m.body)) work(*jobs);
  }
  void ready() {
    const auto found = pictures().prepared.find(epoch_);
    // The scene is of a session that began in the middle.
    if (found == pictures().prepared.end()) return;
    message::Ready m;
    m.epoch = epoch_;
    m.facts = found->second.facts;
    m.transport = found->second.frame.transport;
    m.stats = found->second.stats;
    if (way_ == Misbehaviour::liesAboutScene) m.stats.scene.triangles++;
    told_ = steadySeconds();
    say(std::move(m));
    if (way_ == Misbehaviour::refusesLater)
      say(message::Failed{.epoch = epoch_, .why = "no memory"});
  }
  void work(const message::Jobs& jobs) {
    if (way_ == Misbehaviour::dies) return die();
    if (way_ != Misbehaviour::answersNonsense && way_ != Misbehaviour::answersOthers) return;
    for (const LeasedJob& job : jobs.jobs) {
      message::Result m;
      m.epoch = jobs.epoch;
      m.lease = job.lease + (way_ == Misbehaviour::answersOthers ? 1000000 : 0);
      m.seconds = 0.001;
      m.bytes = someBytes(64, uint32_t(job.lease));
      say(std::move(m));
    }
  }
  void say(message::Body&& body) { wire_->send(peer_, encode(session_, std::move(body))); }
  void die() {
    wire_.reset();
    session_ = 0;
    epoch_ = 0;
  }

  Misbehaviour way_;
  std::string address_;
  std::optional<Wire> wire_;
  int socket_ = -1;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  Peer peer_ = 0;
  uint64_t session_ = 0;
  Epoch epoch_ = 0;
  double joined_ = 0, told_ = 0;
};

struct Outcome {
  std::string said;    // the log
  std::string failure; // message of the exception of wait()
  double longest = 0;  // longest time in seconds without progress
  bool right = true;   // whether the pictures have the expected bytes
  double last = 0;     // seconds that the last picture took
};

// Renders two pictures with these workers. A picture that would wait forever is cancelled after a
// while.
Outcome render(std::vector<Misbehaviour> ways, ClusterOptions cluster) {
  std::vector<std::unique_ptr<UselessWorker>> workers;
  for (const Misbehaviour way : ways)
    cluster.workers.push_back(
        (workers.emplace_back(std::make_unique<UselessWorker>(way)))->address());
  Outcome out;
  BackendOptions options;
  options.threads = 1;
  options.shaders = &pictures().shaders;
  struct Log {
    std::mutex mutex;
    std::string text;
  } log;
  options.log = [](int, const char* text, void* user) {
    Log& to = *static_cast<Log*>(user);
    const std::lock_guard lock(to.mutex);
    to.text.append(text).append("\n");
  };
  options.logUser = &log;
  {
    const auto backend = makeClusterBackend(options, cluster);
    for (uint32_t i = 0; i < frames; i++) {
      backend->apply(pictures().commits[i]);
      const double begin = steadySeconds();
      backend->start();
      std::atomic<bool> over{false};
      std::thread watch([&] {
        float before = -1;
        for (double since = steadySeconds(); !over;
             std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
          const float is = backend->progress();
          if (is != before) since = steadySeconds();
          before = is;
          out.longest = std::max(out.longest, steadySeconds() - since);
          if (steadySeconds() - since > promised + 2 * slack)
            backend->cancel(); // it would wait forever
        }
      });
      try {
        backend->wait();
        out.right = out.right && Pictures::read(*backend) == pictures().expected[i];
      } catch (const ClusterError& e) { out.failure = e.what(); }
      over = true;
      watch.join();
      out.last = steadySeconds() - begin;
    }
  }
  out.said = log.text;
  return out;
}

// Runs all cases at the same time, because they spend nearly all of it waiting.
std::map<Misbehaviour, Outcome> renderAll(const ClusterOptions& cluster) {
  pictures();
  std::map<Misbehaviour, std::future<Outcome>> running;
  for (const auto& [way, name] : names)
    running[way] =
        std::async(std::launch::async, [=, way = way] { return render({way}, cluster); });
  std::map<Misbehaviour, Outcome> all;
  for (auto& [way, future] : running) all[way] = future.get();
  return all;
}

} // namespace

TEST(Useless, aMasterThatLeavesAllToOthersHelpsInTime) {
  ClusterOptions cluster;
  cluster.local = 0;
  for (const auto& [way, out] : renderAll(cluster)) {
    EXPECT_TRUE(out.right) << names.at(way);
    EXPECT_EQ(out.failure, "") << names.at(way);
    EXPECT_LT(out.longest, promised + slack) << names.at(way);
    EXPECT_NE(out.said, "") << names.at(way) << ": whoever renders alone says so";
    if (way != Misbehaviour::comesAndGoes && way != Misbehaviour::dies &&
        way != Misbehaviour::answersNonsense) {
      EXPECT_LT(out.last, promised * slowness)
          << names.at(way) << ": a second picture does not wait as long once more";
    }
  }
}

TEST(Useless, threadsHereDoWhatNobodyElseDoes) {
  for (const char* split : {"auto", "frames"}) {
    ClusterOptions cluster;
    cluster.local = 1;
    cluster.split = split;
    for (const auto& [way, out] : renderAll(cluster)) {
      EXPECT_TRUE(out.right) << names.at(way) << ", " << split;
      EXPECT_EQ(out.failure, "") << names.at(way) << ", " << split;
      EXPECT_LT(out.longest, promised + slack) << names.at(way) << ", " << split;
    }
  }
}

TEST(Useless, whereAWorkerIsRequiredThePictureIsMadeOrRefusedInTime) {
  ClusterOptions cluster;
  cluster.local = 0;
  cluster.require = 1;
  for (const auto& [way, out] : renderAll(cluster)) {
    EXPECT_LT(out.longest, promised + slack) << names.at(way);
    EXPECT_TRUE(!out.failure.empty() || out.right) << names.at(way);
    if (way == Misbehaviour::refuses || way == Misbehaviour::otherVersion ||
        way == Misbehaviour::nobody) {
      EXPECT_NE(out.failure.find("1 worker is needed"), std::string::npos)
          << names.at(way) << ": " << out.failure;
    }
    if (way == Misbehaviour::refuses) {
      EXPECT_NE(out.failure.find("differs from the master"), std::string::npos)
          << "it says why: " << out.failure;
    }
  }
}

// A job is issued to several workers, and all of them keep it.
TEST(Useless, manyThatOnlyBeatDoNotSwallowAJob) {
  for (const uint32_t local : {0u, 1u}) {
    ClusterOptions cluster;
    cluster.local = local;
    const Outcome out = render(std::vector<Misbehaviour>(7, Misbehaviour::beatsOnly), cluster);
    EXPECT_TRUE(out.right);
    EXPECT_LT(out.longest, promised + slack);
  }
}
