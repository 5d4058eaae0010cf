// debug.cpp: the backend of backend=debug:NAME. It forwards everything to the rendering backend,
// keeps its own copy of the scene, and explains misuse through the log callback: the problem, the
// place and the remedy. It costs memory for the tables and time for each commit; the pictures are
// those of the rendering backend. Application thread; cancel, progress and snapshot from any.
#include <set>
#include <utility>

#include "backend/debug/rules.h"
#include "backend/forwarding.h"
#include "shading/registry.h"

namespace openrt {
namespace {

using namespace debug;

class DebugBackend final : public ForwardingBackend {
 public:
  DebugBackend(const BackendOptions& options, std::unique_ptr<Backend> renderer)
      : ForwardingBackend(std::move(renderer)), options_(options) {}

  void apply(std::shared_ptr<const Commit> commit) override {
    const SceneChanges changes = scene_.apply(*commit);
    for (const auto& entry : commit->edits.edits) {
      if (!entry) continue;
      if (const auto* object = entry->any.AsObject()) {
        ObjectHistory& history = histories_[object->id];
        if (history.definitions++ == 0) history.hinted = object->dynamic;
        uncheckedObjects_.insert(object->id);
      }
      if (const auto* deleted = entry->any.AsDeleteObject()) {
        histories_.erase(deleted->id);
        uncheckedObjects_.erase(deleted->id);
      }
    }
    changed_ |= changes.any();
    ForwardingBackend::apply(std::move(commit));
  }

  void start() override {
    if (changed_) checkRules();
    changed_ = false;
    ForwardingBackend::start();
  }

 private:
  const RtsClass* classOf(uint32_t shader) const {
    const auto values = scene_.shaders.find(shader);
    if (values == scene_.shaders.end()) return nullptr;
    const auto name = scene_.classes.find(values->second.shaderClass);
    if (name == scene_.classes.end() || !options_.shaders) return nullptr;
    try {
      return &options_.shaders->find(name->second.name, name->second.library);
      // The rendering backend reports it.
    } catch (const std::exception&) { return nullptr; }
  }

  void checkRules() {
    if (!options_.log) return;
    const RuleContext facts{scene_, [this](uint32_t shader) { return classOf(shader); }, histories_,
                            memory_};
    for (const auto rules : {sceneRules(), shaderRules()})
      for (const Rule& rule : rules) rule.check(facts, reporter(rule.name));
    for (uint32_t id : std::exchange(uncheckedObjects_, {})) {
      const auto object = scene_.objects.find(id);
      if (object == scene_.objects.end()) continue;
      for (const ObjectRule& rule : objectRules())
        rule.check(id, object->second, facts, reporter(rule.name));
    }
  }

  Report reporter(const char* rule) {
    return [this, rule](uint32_t id, const std::string& text) {
      if (!reported_.emplace(rule, id).second) return;
      options_.log(2, ("debug: " + std::string(rule) + ": " + text).c_str(), options_.logUser);
    };
  }

  BackendOptions options_;
  Scene scene_;
  std::map<uint32_t, ObjectHistory> histories_;
  UsageHistory memory_;
  std::set<uint32_t> uncheckedObjects_; // objects defined since the last check
  std::set<std::pair<std::string, uint32_t>> reported_;
  bool changed_ = false;
};

} // namespace

std::unique_ptr<Backend> makeDebugBackend(const BackendOptions& options,
                                          std::unique_ptr<Backend> renderer) {
  return std::make_unique<DebugBackend>(options, std::move(renderer));
}

} // namespace openrt
