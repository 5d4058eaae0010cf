#include "server/served_world.h"

#include <utility>

#include <fmt/format.h>

#include "process/messages.h"
#include "server/texts.h"
#include "start/world_start.h"

namespace vv::server {

ServedWorld::ServedWorld(const Options& options, Callbacks callbacks)
    : options_(options), callbacks_(std::move(callbacks)), problems_(options) {}

void ServedWorld::openFirst() {
  std::unique_ptr<xvrml::World> world =
      xvrml::loadWorld(options_.input, loadOptionsForShowing(options_));
  begin(std::move(world), "", {options_.render.width, options_.render.height}, nullptr);
}

void ServedWorld::reload() {
  const std::string path = session_->browser().world().path;
  if (path == "-") return callbacks_.onMessage("standard input cannot be read again");
  open({{path}, "", {}}, true);
}

void ServedWorld::revert() {
  if (session_->browser().world().path == "-")
    throw xvrml::EditError("standard input cannot be read again");
  isReverted_ = true;
  reload();
}

void ServedWorld::recover() {
  WorldEditor& editor = session_->editor();
  if (editor.isChanged()) throw xvrml::EditError("save or undo the edits of now first");
  open({{session_->browser().world().path}, "", {}, editor.journal().take()}, true);
}

void ServedWorld::watch(double now) {
  if (std::exchange(saves_, session_->editor().saves()) != saves_)
    watch_.follow(session_->browser().world());
  if (watch_.changed(now)) reload();
}

// Another world takes the place of this one. Tells everybody if edits would be lost by that.
bool ServedWorld::refuseWhileUnsaved() const {
  if (isReverted_ || !session_->editor().isChanged()) return false;
  callbacks_.onMessage("the world has edits that are not saved: save or undo them first");
  return true;
}

void ServedWorld::open(LoadRequest request, bool keepPlace) {
  if (refuseWhileUnsaved()) return;
  request.options = loadOptionsForShowing(options_);
  keepPlace_ = keepPlace;
  loading_ = request.urls.empty() ? "" : request.urls[0];
  loader_.begin(std::move(request));
}

// The first URL decides: a page of the web is opened by the browser of the user, a file here.
void ServedWorld::openUrls(const std::vector<std::string>& urls, const std::string& base) {
  const std::string page = webUrlOf(urls);
  if (!page.empty() && page == urls.front()) return callbacks_.openPage(page);
  open({urls, base, {}}, false);
}

bool ServedWorld::take(PictureSize size) {
  if (!session_->resting()) return false; // the old session cannot end yet
  LoadAnswer answer;
  if (!loader_.take(answer)) return false;
  loading_.clear();
  if (refuseWhileUnsaved()) return false; // they were made while it was read
  const std::shared_ptr<LeftEdits> left = answer.left;
  const std::string wrong = useWorld(std::move(answer), [&](std::unique_ptr<xvrml::World> world,
                                                            const std::string& fragment) {
                              begin(std::move(world), fragment, size, left.get());
                            }).wrong;
  if (wrong.empty()) return true;
  isReverted_ = false;
  sayError(wrong);
  callbacks_.onMessage(wrong);
  return false;
}

void ServedWorld::begin(std::unique_ptr<xvrml::World> world, const std::string& fragment,
                        PictureSize size, LeftEdits* left) {
  std::optional<Session::Place> place;
  if (std::exchange(keepPlace_, false) && session_) place = session_->place();
  world->options.loadInlines = true;
  Session::Callbacks calls;
  calls.onAction = [this](const InputEvent& event, Action action) {
    callbacks_.onAction(0, event, action);
  };
  calls.onGuestAction = callbacks_.onAction;
  calls.openUrl = [this](const std::vector<std::string>& urls, const std::string& base) {
    openUrls(urls, base);
  };
  auto fresh =
      std::make_unique<Session>(std::move(world), options_, problems_, std::move(calls), nullptr);
  if (left) fresh->editor().journal().adopt(*left);
  fresh->begin(size.width, size.height, place, fragment);
  callbacks_.onLeave();
  if (isReverted_)
    session_->editor().journal().throwAway();
  else
    keepEdits(session_.get());
  session_ = std::move(fresh); // ends the previous session
  if (options_.serve.edit) session_->editor().journal().look();
  watch_.follow(session_->browser().world());
  saves_ = 0;
  isReverted_ = false;
}

std::optional<InputEvent> ServedWorld::viewpointEvent(int number) {
  std::vector<xvrml::ViewpointInfo> list;
  for (const xvrml::ViewpointName& one : session_->browser().viewpoints())
    list.push_back({one.name, one.description, one.node, {}});
  if (size_t(number) >= list.size()) return {};
  InputEvent event;
  event.kind = InputEvent::Kind::viewpoint;
  for (const std::string& text :
       {std::to_string(number), list[size_t(number)].name, list[size_t(number)].description}) {
    event.text = text;
    if (picture::findViewpoint(list, text) == number) return event;
  }
  return {};
}

} // namespace vv::server
