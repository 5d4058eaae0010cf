#include "session/world_loader.h"

#include <atomic>
#include <new>
#include <thread>
#include <utility>

namespace vv {

namespace {

constexpr int mostThreads = 4; // that read at a time, whether their worlds are wanted or not
std::atomic<int> threads{0};

LoadAnswer load(const LoadRequest& request) {
  LoadAnswer answer;
  answer.left = request.left;
  for (const std::string& url : request.urls) {
    std::string path = url, why;
    if (!request.base.empty()) {
      const xvrml::ResolvedUrl resolved = xvrml::resolveUrl(url, request.base, request.options);
      path = resolved.path;
      why = resolved.error;
      answer.fragment = resolved.fragment;
    }
    try {
      if (why.empty())
        answer.world = request.left ? xvrml::loadWorldFromMemory(request.left->content.text, path,
                                                                 request.options)
                                    : xvrml::loadWorld(path, request.options);
    } catch (const xvrml::LoadError& error) {
      why = error.diagnostic.text();
    } catch (const Failure& failure) { why = failure.text; } catch (const std::bad_alloc&) {
      why = path + ": not enough memory";
    } catch (const std::exception& error) { why = path + ": " + error.what(); }
    if (answer.world) break;
    if (answer.error.size() < 400) answer.error += (answer.error.empty() ? "" : "; ") + why;
  }
  if (answer.world) answer.error.clear();
  if (!answer.world && answer.error.empty()) answer.error = "there is no URL";
  return answer;
}

} // namespace

LoadOutcome useWorld(LoadAnswer answer,
                     const std::function<void(std::unique_ptr<xvrml::World> world,
                                              const std::string& fragment)>& begin) {
  if (!answer.world) return {answer.error, exitInput};
  try {
    begin(std::move(answer.world), answer.fragment);
    return {};
  } catch (const Failure& failure) {
    return {failure.text, failure.code};
  } catch (const UsageError& error) {
    return {error.what(), exitUsage};
  } catch (const std::exception& error) { return {error.what(), exitInput}; }
}

struct WorldLoader::Reading {
  LoadRequest request;
  LoadAnswer answer;
  std::atomic<bool> done{false};
};

WorldLoader::~WorldLoader() = default;

void WorldLoader::begin(LoadRequest request) {
  reading_ = nullptr;
  wanted_ = std::move(request);
  startIfPossible();
}

// Reading cannot be cancelled, and Scripts may ask for worlds again and again.
void WorldLoader::startIfPossible() {
  if (!wanted_ || threads >= mostThreads) return;
  reading_ = std::make_shared<Reading>();
  reading_->request = *std::exchange(wanted_, {});
  ++threads;
  std::thread([reading = reading_]() mutable {
    reading->answer = load(reading->request);
    reading->done = true;
    reading = nullptr; // destroys a world that nobody wants any more, before the process may end
    --threads;
  }).detach();
}

bool WorldLoader::take(LoadAnswer& answer) {
  startIfPossible();
  if (!reading_ || !reading_->done) return false;
  answer = std::move(reading_->answer);
  reading_ = nullptr;
  return true;
}

bool WorldLoader::working() { return threads > 0; }

} // namespace vv
