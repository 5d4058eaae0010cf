// edit_light.h: The light that the editors of pages look at: probes, what an edit has changed since
// A, and reports. All pages share them; they are of the picture of the page that leads. Owned by
// the editing of the server. [main thread, while the world can be used]
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "server/edit_command.h"
#include "server/host.h"
#include "server/served_world.h"
#include "session/light_reader.h"
#include "session/world_report.h"

namespace vv::server {

class EditLight {
 public:
  // arguments: of the command line. All of them must outlive this object.
  EditLight(ServedWorld& world, Host& host, const std::vector<std::string>& arguments)
      : world_(world), host_(host), arguments_(arguments) {}

  // Does a command of a page. view: that of the page; isLeaders: it is the view of the page that
  // leads. Throws xvrml::EditError.
  void take(uint64_t page, const EditView& view, bool isLeaders, const edit::LightCommand& command);
  // Reads what is due. now: seconds of any clock.
  void update(double now);
  // Returns what is to be said to a page; 0: to all.
  std::vector<std::pair<uint64_t, std::string>> takeMessages();
  void leave(uint64_t page) { light_.leave(page); }
  // The session ends.
  void beginAnew();

  const Probes& probes() { return light_.probes(); }
  // Returns what of A is shown, with the change of light where a page points.
  std::string comparisonText(uint64_t page, bool isLeaders);
  // Returns what is seen where the pointer of a page rests.
  std::string pointerText(uint64_t page, bool isLeaders) const;
  // Returns how far the report is that a page has asked for; "": there is none.
  std::string progress(uint64_t page);
  // Returns the number of the picture that covers the present one, and a message with it; 0: there
  // is none.
  uint64_t cover();
  const std::string& coverText() const { return coverText_; }

 private:
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::PutProbe& put);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::Measure& measure);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::KeepProbes& keep);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::ClearProbes& clear);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::Compare& compare);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::PointAt& point);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::KeepInWorld& keep);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::NameProbe& name);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::ShowSensors& show);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::ProbeTable& table);
  void perform(uint64_t page, const EditView& view, bool isLeaders, const edit::Report& report);
  void needRoom();
  // Returns the probe of a number. Throws xvrml::EditError.
  const Probe& probeOf(int number);

  ServedWorld& world_;
  Host& host_;
  const std::vector<std::string>& arguments_;
  LightReader light_;
  uint64_t cover_ = 0; // the number of the cover that coverText_ has
  std::string coverText_;
  uint64_t reporter_ = 0; // the page that has asked for the last report
  WorldReport report_;    // the last member: its thread uses the others
};

} // namespace vv::server
