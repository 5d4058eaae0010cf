// processes.h: the processes for a world's Scripts. Each Script gets a process of its own up to a
// maximum number; then they share. A process whose Scripts have ended is reused. [the browser's
// thread]
#pragma once

#include <map>

#include "script/remote/process.h"

namespace xvrml {

using ProcessRef = std::shared_ptr<ScriptProcess>;

class ScriptProcesses {
 public:
  // Limit on the processes of a world; every engine gets at least one.
  static constexpr size_t most = 16;
  // The number of processes that programs may end. It bounds the time spent on starting new ones.
  static constexpr size_t maxEnded = 100;
  explicit ScriptProcesses(const XsHost& host) : host_(host) {}
  ~ScriptProcesses();
  ScriptProcesses(const ScriptProcesses&) = delete;
  ScriptProcesses& operator=(const ScriptProcesses&) = delete;

  // Returns a process for another interpreter: ready, perhaps busy. coming: how many more will be
  // requested soon; they are started in parallel. Returns null, with the reason, if none can be
  // started.
  ProcessRef choose(const ProcessSettings& settings, size_t coming, std::string& why);
  void trim(); // keeps only one of the unused processes, for the next Script
  void programEnded() { ++ended_; }
  void remove(const ScriptProcess& process);
  const std::vector<ProcessRef>& all() const { return all_; }

 private:
  bool start(const ProcessSettings& settings);
  const XsHost& host_;
  std::string program_, whyNoProgram_;
  std::vector<ProcessRef> all_;
  size_t ended_ = 0;
  // By library and engine: the reason why no process can be started.
  std::map<std::string, std::string> unusable_;
};

} // namespace xvrml
