// reports.h: Tells pages what has changed for them: the list of viewpoints, the facts about their
// picture, hints and messages. Owned by the server. [main thread]
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "server/host.h"
#include "server/pages.h"
#include "server/served_world.h"

namespace vv::server {

class Reports {
 public:
  // The pages and the world must outlive this object.
  Reports(Pages& pages, ServedWorld& world) : pages_(pages), world_(world) {}

  // Shows a text at the bottom of a view's picture until a time of the caller's clock.
  void notify(uint32_t view, const std::string& text, double ends);
  void endView(uint32_t view) { notices_.erase(view); }
  void leave(uint64_t page) { told_.erase(page); }
  // There is a new session, which pages know nothing of.
  void beginAnew();
  // Something has changed: the next call of tell() is not too early.
  void hurry() { next_ = 0; }
  // Sends pages what they do not know yet, a few times a second, or less often if nothing
  // `changes`. now: time of the same clock. [while the world can be used]
  void tell(double now, bool changes, Host& host);

 private:
  struct Told { // what a page was told last
    std::string state, viewpoints;
  };
  struct Notice {
    std::string text;
    double ends = 0;
  };

  void takeMessages(double now);
  void readViewpoints(double now);
  std::string bottomOf(const Page& page, double now);
  std::string stateOf(const Page& page, double now);

  Pages& pages_;
  ServedWorld& world_;
  std::map<uint64_t, Told> told_;
  std::map<uint32_t, Notice> notices_;         // by view
  std::vector<const xvrml::Node*> viewpoints_; // for comparison; they may be gone
  std::string viewpointsText_;                 // the message that lists them
  double viewpointsDue_ = 0;                   // when they are read again
  double next_ = 0;                            // time of the next report
};

} // namespace vv::server
