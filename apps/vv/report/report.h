// report.h: what vv tells about a world and about a picture it made, for people and as JSON. [main
// thread]
#pragma once

#include <memory>
#include <string>

#include "libpicture/renderer.h"
#include "options/names.h"
#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

struct RunTimes {
  double write = 0, total = 0; // seconds
};
// Holds what statistics say of a running world.
struct RunningWorld {
  const xvrml::World& world;
  xvrml::ScriptCounts scripts;
};

// The statistics of a picture as JSON, schema 1.
std::string statsJson(const Options& options, const std::string& commandLine,
                      const RunningWorld& running, const picture::RenderResult& result,
                      const RunTimes& times);

// The statistics of a sequence: sums, and the times of each picture. Also schema 1: `frames` is
// there besides.
class SequenceStats {
 public:
  SequenceStats();
  ~SequenceStats();
  void add(const PictureName& name, double worldTime, const picture::RenderResult& result,
           double writeSeconds);
  std::string json(const Options& options, const std::string& commandLine,
                   const RunningWorld& running, double totalSeconds) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// How light is followed in a world, and what it is rendered as (OpenRTMapper::explain). stats: of
// any picture of it.
std::string explainWorld(const Options& options, const xvrml::World& world, const RTstats& stats,
                         const std::vector<xvrml::ExplainedObject>& objects);

// world may be null: the node types alone.
std::string listNodes(const xvrml::World* world, bool json);
std::string listViewpoints(const std::vector<xvrml::ViewpointInfo>& viewpoints, bool json);
// Which axis is up, and why that is believed; no reason: it is said.
struct UpAxis {
  std::string axis, reason;
};
// scriptPath: where script engines are looked for first.
std::string describeWorld(const xvrml::World& world,
                          const std::vector<xvrml::ViewpointInfo>& viewpoints,
                          const xvrml::Bounds& bounds, const UpAxis& up,
                          const std::string& scriptPath, bool json);

} // namespace vv
