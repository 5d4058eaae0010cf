// world_loader.h: Reads worlds on a thread of its own, while the window continues with the previous
// one. A read that is no longer wanted runs to its end. [one thread]
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "edit/journal.h"
#include "options/values.h"
#include "xvrml/world.h"

namespace vv {

struct LoadRequest {
  std::vector<std::string> urls; // the first one that is a world is loaded; "-": standard input
  std::string base;              // File that the URLs are relative to; empty: they are paths.
  xvrml::LoadOptions options;
  std::shared_ptr<LeftEdits> left{}; // the text is theirs; null: it is that of the file
};

struct LoadAnswer {
  std::unique_ptr<xvrml::World> world; // the loaded world; null: no URL could be read
  std::string fragment;                // fragment of the URL: a viewpoint
  std::string error;                   // why there is no world
  std::shared_ptr<LeftEdits> left{};   // as it was asked for
};

// Tells what became of the world of an answer.
struct LoadOutcome {
  std::string wrong;   // why it is not used; empty if it is
  int code = exitDone; // exit code of the process, which needs the world
};
// Gives the world of an answer to `begin`, whose errors mean that it cannot be used.
LoadOutcome useWorld(LoadAnswer answer,
                     const std::function<void(std::unique_ptr<xvrml::World> world,
                                              const std::string& fragment)>& begin);

class WorldLoader {
 public:
  ~WorldLoader();
  void begin(LoadRequest request); // discards an earlier request
  bool busy() const { return reading_ || wanted_; }
  bool take(LoadAnswer& answer); // returns true once the answer is there
  static bool working();         // true while a thread still reads, wanted or not

 private:
  struct Reading;
  void startIfPossible();

  std::optional<LoadRequest> wanted_; // waits until fewer threads read
  std::shared_ptr<Reading> reading_;
};

} // namespace vv
