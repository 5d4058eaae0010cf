// worker.cpp: a worker's session: masters connect and leave; jobs and results. Scenes:
// worker_scenes.cpp.
#include "backend/cluster/worker/worker.h"

#include <algorithm>

#include "backend/cluster/net/greeting.h"
#include "backend/record/validator.h"
#include "render/film/light_image.h"
#include "render/frame/result_codec.h"

namespace openrt::cluster {
namespace {

constexpr double patience = 5;      // seconds that a master may take to answer
constexpr size_t maxJobs = 1 << 16; // outstanding jobs
constexpr size_t maxFrames = 256;   // frames that are prepared and not dropped

} // namespace

Worker::Worker(const WorkerOptions& options, WorkerLink link, JobExecutor& executor,
               WorkerCounts& counts)
    : options_(options), link_(std::move(link)), executor_(executor), cache_(options.cacheBytes),
      libraries_(options.shaders), counts_(counts) {}

Worker::~Worker() = default;

void Worker::report(int level, const std::string& text) const {
  if (options_.log) options_.log(level, text);
}

void Worker::sendMessage(message::Body&& body) {
  link_.send(peer_, encode(session_, std::move(body)));
}

void Worker::joined(Peer peer, const std::string& address, double now) {
  if (peer_ != 0) return link_.close(peer, "this worker is busy: it serves another master");
  peer_ = peer;
  address_ = address;
  helloSentAt_ = now;
  link_.send(peer, encode(0, message::Hello(options_.self)));
}

void Worker::left(Peer peer, const std::string& why, double) {
  if (peer != peer_) return;
  const std::string text =
      "master " + address_ + (serving() ? " has left: " : " refuses this worker: ") + why;
  // A master that calls again and again is reported once.
  report(serving() ? 1 : text == lastReport_ ? 0 : 2, text);
  lastReport_ = text;
  endSession();
}

// Gives up outstanding jobs; keeps the arrays.
void Worker::endSession() {
  if (serving()) {
    executor_.drop(newest_);
    link_.pace(0, 0);
  }
  peer_ = 0;
  session_ = 0;
  base_ = newest_;
  logged_ = 0;
  pendingScenes_.clear();
  streams_.clear();
  fetched_.clear();
  frames_.clear();
  leases_.clear();
  unanswered_.clear();
  begun_ = unansweredBytes_ = 0;
  broken_ = "no scene has arrived yet";
  validator_.reset();
  cache_.trim();
}

void Worker::advance(double now) {
  if (peer_ == 0 || serving() || now - helloSentAt_ < patience) return;
  link_.close(peer_, "no Welcome has arrived");
  endSession();
}

void Worker::giveUp(const std::string& why) {
  report(3, "master " + address_ + ": " + why);
  link_.close(peer_, why);
  endSession();
}

void Worker::bad(const std::string& why) {
  report(2, "master " + address_ + " has sent an invalid message: " + why);
  link_.bad(peer_, why);
}

void Worker::message(Peer peer, Frames&& frames, double) {
  if (peer != peer_) return;
  Message m;
  if (const std::string why = decode(std::move(frames), m);
      // The intended message is unknown.
      !why.empty()) {
    const std::string text = "a message cannot be read: " + why;
    report(2, "master " + address_ + ": " + text);
    link_.close(peer_, text);
    return endSession();
  }
  const bool greeting = std::holds_alternative<message::Welcome>(m.body);
  // The message belongs to a session that has ended.
  if (!greeting && (!serving() || m.session != session_)) return;
  struct {
    Worker& w;
    uint64_t session;
    void operator()(message::Welcome& m) const { w.welcome(m, session); }
    void operator()(message::Scene& m) const { w.scene(std::move(m)); }
    void operator()(message::Piece& m) const { w.piece(m); }
    void operator()(message::Source& m) const { w.source(m); }
    void operator()(message::Prepare& m) const { w.prepare(m); }
    void operator()(message::Jobs& m) const { w.jobs(m); }
    void operator()(message::Drop& m) const { w.drop(m); }
  } const handler{*this, m.session};
  if (!dispatch<Sender::master>(m.body, handler)) bad("only workers send this message");
}

void Worker::welcome(const message::Welcome& m, uint64_t session) {
  if (serving()) return bad("a second Welcome");
  if (m.session == 0 || session != m.session) return bad("the Welcome has no session");
  if (m.protocol != protocolVersion)
    return giveUp("the master has protocol " + std::to_string(m.protocol) + ", the worker " +
                  std::to_string(protocolVersion) + ": install the same version on both");
  if (!m.isa.empty() && !canUse(options_.self, m.isa))
    return giveUp("instruction set: the master wants " + m.isa + ", the worker has " +
                  options_.self.isas);
  executor_.useInstructionSet(m.isa.empty() ? options_.self.isa : m.isa);
  session_ = m.session;
  counts_.masters++;
  broken_ = "no scene has arrived yet";
  link_.pace(m.heartbeat, m.silence);
  report(1, "serving " + address_);
}

void Worker::jobs(const message::Jobs& m) {
  if (m.epoch == 0 || m.epoch > newest_ - base_)
    return bad("the jobs are of a scene that has not arrived");
  const Epoch epoch = base_ + m.epoch;
  const auto frame = frames_.find(epoch);
  if (frame == frames_.end()) return; // the frame was dropped
  const edit::FrameSettingsT& f = frame->second;
  const uint64_t pixels = uint64_t(f.width) * f.height;
  constexpr uint64_t maxSamples = uint64_t(1) << 17; // per pixel
  const uint32_t parts = f.timeLimit > 0 ? LightImage::mostParts : LightImage::parts;
  for (const LeasedJob& job : m.jobs) {
    const bool samples = job.job.kind == Job::Kind::samples;
    if (samples ? job.job.number >= pixels || uint64_t(job.job.first) + job.job.count > maxSamples
                : job.job.number >= parts)
      return bad("a job is not in the frame");
  }
  size_t out = m.jobs.size();
  for (const auto& [of, leases] : leases_) out += leases.size();
  if (out > maxJobs) return bad("there are more jobs than a worker takes");
  for (const LeasedJob& job : m.jobs)
    if (!leases_[epoch].insert(job.lease).second) return bad("a lease is in use already");
  executor_.work(epoch, m.jobs);
}

void Worker::drop(const message::Drop& m) {
  const Epoch epoch = base_ + std::min(m.epoch, newest_ - base_);
  executor_.drop(epoch);
  frames_.erase(frames_.begin(), frames_.upper_bound(epoch));
  leases_.erase(leases_.begin(), leases_.upper_bound(epoch));
}

void Worker::answered(Epoch epoch) {
  for (; !unanswered_.empty() && unanswered_.front().first <= epoch; unanswered_.pop_front())
    unansweredBytes_ -= unanswered_.front().second;
}

void Worker::ready(Epoch epoch, const Prepared& prepared) {
  if (epoch <= base_ || !serving()) return; // from the session of a former master
  answered(epoch);
  frames_[epoch] = prepared.frame;
  if (frames_.size() > maxFrames) frames_.erase(frames_.begin());
  message::Ready m;
  m.epoch = epoch - base_;
  m.facts = prepared.facts;
  m.transport = prepared.frame.transport;
  m.stats = prepared.stats;
  sendMessage(std::move(m));
}

void Worker::failed(Epoch epoch, const std::string& why) {
  if (epoch <= base_ || !serving()) return;
  answered(epoch);
  leases_.erase(epoch);
  sendMessage(message::Failed{.epoch = epoch - base_, .why = why});
}

void Worker::done(Epoch epoch, const LeasedJob& job, JobResult&& result) {
  counts_.jobs++;
  counts_.seconds += result.seconds;
  counts_.cameraRays += result.counters.camera;
  counts_.shadowRays += result.counters.shadow;
  counts_.secondaryRays += result.counters.secondary;
  if (epoch <= base_ || !serving()) return;
  if (const auto out = leases_.find(epoch); out != leases_.end()) out->second.erase(job.lease);
  const auto frame = frames_.find(epoch);
  if (frame == frames_.end()) return; // the frame was dropped meanwhile
  message::Result m;
  m.epoch = epoch - base_;
  m.lease = job.lease;
  m.seconds = result.seconds;
  m.camera = result.counters.camera;
  m.shadow = result.counters.shadow;
  m.secondary = result.counters.secondary;
  m.faults = faultsOf(result.counters.faults);
  m.bytes = encodeResult(frame->second, job.job, result);
  sendMessage(std::move(m));
}

void Worker::log(int level, const std::string& text) {
  if (serving() && logged_ < limits::logLines)
    sendMessage(message::Log{.level = level, .text = text});
  logged_++;
}

} // namespace openrt::cluster
