#include "script/remote/processes.h"

#include <algorithm>
#include <utility>

namespace xvrml {

ScriptProcesses::~ScriptProcesses() {
  for (const ProcessRef& process : all_)
    process->kill("is not needed any more"); // kill all at once, then wait for each
}

bool ScriptProcesses::start(const ProcessSettings& settings) {
  if (program_.empty() && whyNoProgram_.empty())
    program_ = findHelper(scriptHostProgram, whyNoProgram_);
  if (program_.empty()) return false;
  all_.push_back(std::make_shared<ScriptProcess>(program_, settings, host_));
  return true;
}

ProcessRef ScriptProcesses::choose(const ProcessSettings& settings, size_t coming,
                                   std::string& why) {
  const std::string key = settings.library + ":" + settings.engine;
  if (const auto known = unusable_.find(key); known != unusable_.end()) {
    why = known->second;
    return nullptr;
  }
  if (ended_ >= maxEnded) {
    why = std::to_string(ended_) + " processes have been ended by programs of this world";
    return nullptr;
  }
  std::erase_if(all_, [](const ProcessRef& process) { return process->dead(); });
  const auto fits = [&](const ProcessRef& p) {
    return p->settings().library == settings.library && p->settings().engine == settings.engine;
  };
  const auto empty = size_t(std::count_if(
      all_.begin(), all_.end(), [&](const auto& p) { return fits(p) && p->scripts() == 0; }));
  for (size_t i = empty; i < coming + 1 && all_.size() < most; ++i)
    if (!start(settings)) break;
  if (std::none_of(all_.begin(), all_.end(), fits)) start(settings);
  why = whyNoProgram_;
  for (;;) {
    ProcessRef best;
    for (const ProcessRef& process : all_)
      if (fits(process) && (!best || process->scripts() < best->scripts())) best = process;
    if (!best) break;
    if (best->ready()) return best;
    why = best->death();
    remove(*best);
  }
  unusable_[key] = why;
  return nullptr;
}

void ScriptProcesses::trim() {
  bool kept = false;
  std::erase_if(all_, [&](const ProcessRef& p) {
    return p->scripts() == 0 && (p->dead() || p->busy() || std::exchange(kept, true));
  });
}

void ScriptProcesses::remove(const ScriptProcess& process) {
  std::erase_if(all_, [&](const ProcessRef& other) { return other.get() == &process; });
}

} // namespace xvrml
