// editing.h: The editor of `vv serve --edit` on pages: does what their users ask for, and tells
// their pages what there is to show. All editors have one history, one selection and one list of
// probes; each page has its own place in the outline. Owned by the server. [main thread, while the
// world can be used]
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "as_json/node_numbers.h"
#include "edit/edit_model.h"
#include "edit/probes.h"
#include "server/edit_command.h"
#include "server/host.h"
#include "server/limits.h"
#include "server/pages.h"
#include "server/served_world.h"

namespace vv::server {

class Editing {
 public:
  // All of them must outlive this object.
  Editing(Pages& pages, ServedWorld& world, Host& host)
      : pages_(pages), world_(world), host_(host) {}

  // Tells a page that it may edit.
  void join(uint64_t page);
  // Ends what a page has begun: nothing that it has changed is lost.
  void leave(uint64_t page);
  // Does a command of a page that may edit. Its user is told why it is refused.
  void take(uint64_t page, const edit::Command& command);
  // Tells whether a page shows the editor. A click on its picture selects, then.
  bool isOpen(uint64_t page) const { return faces_.contains(page); }
  // The session ends, and the next one's world has not been edited.
  void beginAnew();
  // Tells the pages what has changed for them. now: seconds of any clock.
  void update(double now);

 private:
  // The editor on one page.
  struct Face {
    EditModel model;
    json::NodeNumbers numbers{size_t(maxNodeNumbers)};
    int first = 0, count = 0;                // the rows of the outline that it shows
    std::map<std::string, std::string> told; // the last message of each type
    bool isDragging = false;
    // The parameter of a shader that is dragged, which gets a field at the end.
    struct Parameter {
      xvrml::NodeRef shader;
      std::string name;
      xvrml::Value value;
    };
    std::optional<Parameter> parameter;
    bool isStale = true; // it is told at once, whatever has changed
    double next = 0;     // when it is told again
  };

  WorldEditor& editor() { return world_.session().editor(); }
  EditView viewOf(uint64_t page);
  bool open(uint64_t page);
  void endDrag(uint64_t page, Face& face);
  // Ends all drags, so that what they have changed can be saved and undone.
  void endDrags();
  void say(uint64_t page, const std::string& text, bool isError);
  void tell(uint64_t page, Face& face, const std::string& type, std::string text);
  void show(uint64_t page, Face& face);
  void readProbes(Session& session, double now);

  void perform(uint64_t page, Face& face, const edit::ShowRows& rows);
  void perform(uint64_t page, Face& face, const edit::Search& search);
  void perform(uint64_t page, Face& face, const edit::Open& open);
  void perform(uint64_t page, Face& face, const edit::Select& select);
  void perform(uint64_t page, Face& face, const edit::SelectAt& select);
  void perform(uint64_t page, Face& face, const edit::Drag& drag);
  void perform(uint64_t page, Face& face, const edit::EndDrag& end);
  void perform(uint64_t page, Face& face, const edit::Reset& reset);
  void perform(uint64_t page, Face& face, const json::edits::Step& step);
  void perform(uint64_t page, Face& face, const edit::Add& add);
  void perform(uint64_t page, Face& face, const edit::Duplicate& duplicate);
  void perform(uint64_t page, Face& face, const edit::Remove& remove);
  void perform(uint64_t page, Face& face, const edit::Wrap& wrap);
  void perform(uint64_t page, Face& face, const edit::Undo& undo);
  void perform(uint64_t page, Face& face, const edit::Save& save);
  void perform(uint64_t page, Face& face, const edit::Revert& revert);
  void perform(uint64_t page, Face& face, const edit::Recover& recover);
  void perform(uint64_t page, Face& face, const edit::PutProbe& put);
  void perform(uint64_t page, Face& face, const edit::KeepProbes& keep);
  void perform(uint64_t page, Face& face, const edit::ClearProbes& clear);
  void perform(uint64_t page, Face& face, const edit::Close& close);

  Pages& pages_;
  ServedWorld& world_;
  Host& host_;
  std::map<uint64_t, Face> faces_; // by page
  Probes probes_;
  double probesRead_ = 0;     // when
  uint64_t finishedRead_ = 0; // the number of the finished frame that they were read from
};

} // namespace vv::server
