// processes.cpp: see processes.h.
#include "script/remote/processes.h"

#include <algorithm>

namespace xvrml {

ScriptProcesses::~ScriptProcesses() {
  for (const ProcessRef& process : all_) process->kill("is not needed any more"); // all at once, then each is waited for
}

bool ScriptProcesses::start(const ProcessSettings& settings) {
  if (program_.empty() && noProgram_.empty()) program_ = findScriptHostProgram(noProgram_);
  if (program_.empty()) return false;
  all_.push_back(std::make_shared<ScriptProcess>(program_, settings, host_));
  return true;
}

ProcessRef ScriptProcesses::choose(const ProcessSettings& settings, size_t coming, std::string& why) {
  const std::string key = settings.library + ":" + settings.engine;
  if (const auto known = unusable_.find(key); known != unusable_.end()) return why = known->second, nullptr;
  std::erase_if(all_, [](const ProcessRef& process) { return process->dead(); });
  const auto fits = [&](const ProcessRef& p) {
    return p->settings().library == settings.library && p->settings().engine == settings.engine;
  };
  const auto empty = size_t(std::count_if(all_.begin(), all_.end(), [&](const auto& p) { return fits(p) && p->scripts() == 0; }));
  for (size_t i = empty; i < coming + 1 && all_.size() < most; ++i)
    if (!start(settings)) break;
  if (std::none_of(all_.begin(), all_.end(), fits)) start(settings);
  ProcessRef best;
  for (const ProcessRef& process : all_)
    if (fits(process) && (!best || process->scripts() < best->scripts())) best = process;
  if (best && best->ready()) return best;
  why = best ? best->death() : noProgram_;
  unusable_[key] = why;
  std::erase_if(all_, [&](const ProcessRef& p) { return fits(p) && p->scripts() == 0; });
  return nullptr;
}

bool ScriptProcesses::spare(const ScriptProcess& process) const {
  return std::none_of(all_.begin(), all_.end(), [&](const ProcessRef& other) {
    return other.get() != &process && !other->dead() && other->scripts() == 0;
  });
}

void ScriptProcesses::remove(const ScriptProcess& process) {
  std::erase_if(all_, [&](const ProcessRef& other) { return other.get() == &process; });
}

} // namespace xvrml
