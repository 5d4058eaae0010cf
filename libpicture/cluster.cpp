#include "libpicture/cluster.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "libpicture/renderer.h"
#include "libpicture/stage.h"

namespace picture {

namespace {

// Messages of the backend about its workers begin with this tag; all others are about the scene.
constexpr std::string_view clusterTag = "cluster: ";
constexpr auto patience = std::chrono::milliseconds(50);

} // namespace

void addQuoted(std::string& configuration, const char* key, const std::string& value) {
  if (value.find('"') != value.npos)
    throw RenderError(fmt::format("{}: a double quote is not possible in {}", key, value));
  configuration += fmt::format(" {}=\"{}\"", key, value);
}

std::string clusterConfiguration(const ClusterSettings& s) {
  std::string text = "backend=cluster";
  if (!s.workers.empty()) addQuoted(text, "workers", s.workers);
  if (!s.listen.empty()) addQuoted(text, "listen", s.listen);
  if (!s.key.empty()) addQuoted(text, "key", s.key);
  if (!s.allow.empty()) addQuoted(text, "allow", s.allow);
  if (!s.split.empty()) addQuoted(text, "split", s.split);
  if (s.localThreads >= 0) text += fmt::format(" local={}", s.localThreads);
  if (s.require > 0) text += fmt::format(" require={}", s.require);
  if (s.tolerant) text += " tolerant=1";
  return text;
}

struct Cluster::Impl {
  ClusterSettings settings;
  RTcontext context = nullptr;
  mutable std::mutex mutex; // protects the members below
  std::condition_variable changed;
  bool isBorrowed = false;
  Listener listener;
  std::vector<ClusterMessage> notes;

  // [any engine thread]
  static void listen(int level, const char* text, void* self) {
    auto& impl = *static_cast<Impl*>(self);
    constexpr size_t most = 1000;
    const std::string_view said = text;
    const std::lock_guard lock(impl.mutex);
    if (!said.starts_with(clusterTag)) {
      if (impl.listener) impl.listener(level, text);
    } else if (impl.notes.size() < most) {
      impl.notes.push_back({level, std::string(said.substr(clusterTag.size()))});
    }
  }
};

Cluster::Cluster(const ClusterSettings& settings, const RenderSettings& rendering)
    : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
  const RTcontext before = rtGetCurrent();
  impl_->context = newContext(clusterConfiguration(settings) + contextConfiguration(rendering));
  rtLogCallback(Impl::listen, impl_.get());
  rtMakeCurrent(before);
}

Cluster::~Cluster() { rtDeleteContext(impl_->context); }

const ClusterSettings& Cluster::settings() const { return impl_->settings; }

std::vector<RTworker> Cluster::workers() const {
  std::vector<RTworker> list;
  RTworker probe{};
  probe.size = sizeof probe;
  for (size_t count = rtGetWorkers(impl_->context, &probe, 1); count > list.size();) {
    list.assign(count, RTworker{});
    list[0].size = sizeof(RTworker);
    // a worker may have joined since the first call
    count = rtGetWorkers(impl_->context, list.data(), list.size());
    if (count < list.size()) list.resize(count);
  }
  return list;
}

size_t Cluster::alive() const {
  size_t count = 0;
  for (const RTworker& worker : workers()) count += worker.alive && !isHere(worker);
  return count;
}

bool Cluster::wait(size_t count, double seconds, const std::function<bool()>& stop) const {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (alive() < count) {
    if (std::chrono::steady_clock::now() >= end || (stop && stop())) return false;
    std::this_thread::sleep_for(patience);
  }
  return true;
}

std::vector<ClusterMessage> Cluster::takeMessages() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->notes, {});
}

RTcontext Cluster::borrow(Listener listener, const std::function<bool()>& stop) {
  std::unique_lock lock(impl_->mutex);
  while (impl_->isBorrowed) {
    if (stop && stop()) return nullptr;
    impl_->changed.wait_for(lock, patience);
  }
  impl_->isBorrowed = true;
  impl_->listener = std::move(listener);
  lock.unlock();
  rtMakeCurrent(impl_->context);
  return impl_->context;
}

void Cluster::giveBack() {
  rtCancel(impl_->context);
  while (rtFinishFrame()) {}
  rtErrorCallback(nullptr, nullptr);
  rtMakeCurrent(nullptr);
  while (rtGetError() != RT_NO_ERROR) {}
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->listener = nullptr;
    impl_->isBorrowed = false;
  }
  impl_->changed.notify_all();
}

} // namespace picture
