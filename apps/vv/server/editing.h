// editing.h: The editor of `vv serve --edit` on pages: does what their users ask for, and tells
// their pages what there is to show. All editors have one history, one selection, one list of
// probes and one A; each page has its own place in the outline, and a tool. Owned by the server.
// [main thread, while the world can be used]
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "as_json/node_numbers.h"
#include "edit/edit_model.h"
#include "edit/hiding.h"
#include "server/edit_command.h"
#include "server/edit_light.h"
#include "server/host.h"
#include "server/limits.h"
#include "server/page_looks.h"
#include "server/page_tool.h"
#include "server/pages.h"
#include "server/served_world.h"
#include "server/upload.h"

namespace vv::server {

class Editing {
 public:
  // arguments: of the command line. All of them must outlive this object.
  Editing(Pages& pages, ServedWorld& world, Host& host, const std::vector<std::string>& arguments)
      : pages_(pages), world_(world), host_(host), light_(world, host, arguments), looks_(host) {}

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
    PageTool tool;
    Upload upload;
    json::NodeNumbers numbers{size_t(maxNodeNumbers)};
    int first = 0, count = 0;                // the rows of the outline that it shows
    std::map<std::string, std::string> told; // the last message of each type
    uint64_t cover = 0;                      // the number of the last cover that it was sent
    uint64_t thumbnails = 0;                 // TextureThumbnails::count() when it was sent them
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
  bool showsLeadersView(uint64_t page);
  bool open(uint64_t page);
  void endDrag(uint64_t page, Face& face);
  // Ends all drags and tools, so that what they have changed can be saved and undone.
  void endDrags();
  void endTools();
  void say(uint64_t page, const std::string& text, bool isError);
  void tell(uint64_t page, Face& face, const std::string& type, std::string text);
  void show(uint64_t page, Face& face);
  void showLight(uint64_t page, Face& face);

  void perform(uint64_t page, Face& face, const edit::ShowRows& rows);
  void perform(uint64_t page, Face& face, const edit::Search& search);
  void perform(uint64_t page, Face& face, const edit::Open& open);
  void perform(uint64_t page, Face& face, const edit::Select& select);
  void perform(uint64_t page, Face& face, const edit::SelectAt& select);
  void perform(uint64_t page, Face& face, const edit::SelectIn& select);
  void perform(uint64_t page, Face& face, const edit::SelectSameLook& select);
  void perform(uint64_t page, Face& face, const edit::AskChoices& ask);
  void perform(uint64_t page, Face& face, const edit::ShowList& show);
  void perform(uint64_t page, Face& face, const edit::Hide& hide);
  void perform(uint64_t page, Face& face, const edit::Frame& frame);
  void perform(uint64_t page, Face& face, const edit::Close& close);
  void perform(uint64_t page, Face& face, const edit::Drag& drag);
  void perform(uint64_t page, Face& face, const edit::EndDrag& end);
  void perform(uint64_t page, Face& face, const edit::Undo& undo);
  void perform(uint64_t page, Face& face, const edit::Save& save);
  void perform(uint64_t page, Face& face, const edit::Revert& revert);
  void perform(uint64_t page, Face& face, const edit::Recover& recover);
  void perform(uint64_t page, Face& face, const edit::NodeCommand& command);
  void perform(uint64_t page, Face& face, const edit::ToolCommand& command);
  void perform(uint64_t page, Face& face, const edit::LightCommand& command);
  void perform(uint64_t page, Face& face, const edit::FileCommand& command);

  Pages& pages_;
  ServedWorld& world_;
  Host& host_;
  std::map<uint64_t, Face> faces_; // by page
  Hiding hiding_;
  EditLight light_;
  PageLooks looks_;
};

} // namespace vv::server
