// report.h: Reports about a world and about a rendered picture, for people and as JSON. [main
// thread]
#pragma once

#include <memory>
#include <string>

#include "libpicture/renderer.h"
#include "libpicture/sums.h"
#include "options/names.h"
#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

struct RunTimes {
  double start = 0; // seconds for starting the world: its events and Scripts
  double write = 0; // seconds for writing the files
  // Seconds from the start of the program until the statistics are written, which is the end of its
  // work.
  double total = 0;
};
// The facts of a running world that the statistics contain.
struct RunningWorld {
  const xvrml::World& world;
  xvrml::ScriptCounts scripts;
};

// Returns the statistics of a picture as JSON, schema 1.
std::string statsJson(const Options& options, const std::string& commandLine,
                      const RunningWorld& running, const picture::RenderResult& result,
                      const RunTimes& times);

// Returns the statistics of a picture that vv merge has made of sums.
std::string mergedStatsJson(const std::string& commandLine, const picture::Sums& sums,
                            const RTstats& stats);

// The statistics of a sequence: sums, and the times of each picture. They also use schema 1, with
// the additional member `frames`.
class SequenceStats {
 public:
  SequenceStats();
  ~SequenceStats();
  void add(const PictureName& name, double worldTime, const picture::RenderResult& result,
           double writeSeconds);
  std::string json(const Options& options, const std::string& commandLine,
                   const RunningWorld& running, double startSeconds, double totalSeconds) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

std::string listViewpoints(const std::vector<xvrml::ViewpointInfo>& viewpoints, bool json);
// The up axis, and why it was chosen; the reason is empty if the axis was given.
struct UpAxis {
  std::string axis, reason;
};
// scriptPath: folders that are searched first for script engines.
std::string describeWorld(const xvrml::World& world,
                          const std::vector<xvrml::ViewpointInfo>& viewpoints,
                          const xvrml::Bounds& bounds, const UpAxis& up,
                          const std::string& scriptPath, bool json);

} // namespace vv
