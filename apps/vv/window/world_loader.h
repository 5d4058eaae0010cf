// world_loader.h: reads worlds on a thread of its own, while the window goes on with the former
// one. A read that nobody waits for any more is left to its end. [one thread]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "xvrml/world.h"

namespace vv {

struct LoadRequest {
  std::vector<std::string> urls; // the first that is a world counts; "-": standard input
  std::string base;              // file that they are relative to; empty: they are paths
  xvrml::LoadOptions options;
};

struct LoadAnswer {
  std::unique_ptr<xvrml::World> world; // null: none could be read
  std::string fragment;                // of the URL: a viewpoint
  std::string error;                   // why there is no world
};

class WorldLoader {
 public:
  ~WorldLoader();
  void begin(LoadRequest request); // what was begun before is dropped
  bool busy() const { return job_ != nullptr; }
  bool take(LoadAnswer& answer); // once it is there
  static bool working();         // some thread still reads, wanted or not

 private:
  struct Job;
  std::shared_ptr<Job> job_;
};

} // namespace vv
