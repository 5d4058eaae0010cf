// processes.h: the processes of a world's Scripts. Each Script has one of its own up to a number,
// then they share; those whose Scripts have ended are used again. [the browser's thread]
#pragma once

#include <map>

#include "script/remote/process.h"

namespace xvrml {

using ProcessRef = std::shared_ptr<ScriptProcess>;

class ScriptProcesses {
 public:
  static constexpr size_t most = 16; // of a world; an engine always gets one
  static constexpr size_t mostEnded =
      100; // by programs: starting ever more of them takes time, too
  explicit ScriptProcesses(const XsHost& host) : host_(host) {}
  ~ScriptProcesses();
  ScriptProcesses(const ScriptProcesses&) = delete;
  ScriptProcesses& operator=(const ScriptProcesses&) = delete;

  // The process for another interpreter: ready, perhaps busy. coming: how many more will be asked
  // for soon; they start side by side. Null if none can be started, and why.
  ProcessRef choose(const ProcessSettings& settings, size_t coming, std::string& why);
  void trim(); // of those that nobody is in, one is kept for the next Script
  void programEnded() { ++ended_; }
  void remove(const ScriptProcess& process);
  const std::vector<ProcessRef>& all() const { return all_; }

 private:
  bool start(const ProcessSettings& settings);
  const XsHost& host_;
  std::string program_, noProgram_;
  std::vector<ProcessRef> all_;
  size_t ended_ = 0;
  std::map<std::string, std::string> unusable_; // library and engine: why no process can be started
};

} // namespace xvrml
