#include "server/reports.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "server/texts.h"
#include "session/overlay.h"
#include "steady_clock.h"

namespace vv::server {

namespace {

// Seconds between two reports: while something changes, and while nothing does.
constexpr double interval = 0.15, quietInterval = 1;
constexpr double messageSeconds = 3;
// Reading the viewpoints, which are looked for in the whole world, takes at most this part of the
// time, so that a page is answered as fast in a world of a million nodes.
constexpr double largestShare = 1. / 50;

} // namespace

void Reports::notify(uint32_t view, const std::string& text, double ends) {
  notices_[view] = {text, ends};
  hurry();
}

void Reports::beginAnew() {
  told_.clear();
  notices_.clear();
  viewpointsDue_ = 0;
  hurry();
}

void Reports::takeMessages(double now) {
  Session& session = world_.session();
  if (const std::string text = session.takeMessage(); !text.empty())
    notify(0, text, now + messageSeconds);
  for (const auto& [view, viewer] : session.viewers().all())
    if (const std::string text = view == 0 ? "" : viewer->pilot.takeMessage(); !text.empty())
      notify(view, text, now + messageSeconds);
}

std::string Reports::bottomOf(const Page& page, double now) {
  Session& session = world_.session();
  if (!world_.loading().empty()) return fmt::format("loading {} ...", world_.loading());
  if (page.saving == Page::Saving::picture)
    return fmt::format("Rendering the picture of this instant: {:.0f} samples; Escape gives up",
                       session.captures().samples());
  const auto notice = notices_.find(page.view);
  if (notice != notices_.end() && now < notice->second.ends) return notice->second.text;
  if (const xvrml::ScriptCounts counts = session.browser().scripts(); counts.waiting > 0)
    return fmt::format("starting Scripts: {} of {} ...", counts.scripts - counts.waiting,
                       counts.scripts);
  const std::string hint = session.viewers().findOrOwn(page.view).pilot.hint();
  return hint.empty() ? session.browser().description() : hint;
}

std::string Reports::stateOf(const Page& page, double now) {
  Session& session = world_.session();
  const Pilot& pilot = session.viewers().findOrOwn(page.view).pilot;
  PageState state;
  state.world = std::filesystem::path(session.browser().world().path).filename().string();
  state.role = page.role;
  state.pages = pages_.count();
  for (size_t i = 0; i < viewpoints_.size(); ++i)
    if (viewpoints_[i] == pilot.viewpoint()) state.viewpoint = int(i);
  state.hand = page.role != Page::Role::follower && pilot.overSensor();
  state.bottom = bottomOf(page, now);
  state.keys = page.role != Page::Role::follower && session.browser().sensesKeys();
  state.facts = overlayLines(session.facts(page.view), session.pilot().paused(), OverlayLevel::all);
  return stateText(state);
}

void Reports::readViewpoints(double now) {
  if (now < viewpointsDue_) return;
  const double begun = steadySeconds();
  const std::vector<xvrml::ViewpointName> list = world_.session().browser().viewpoints();
  viewpointsDue_ = now + (steadySeconds() - begun) / largestShare;
  viewpoints_.clear();
  for (const xvrml::ViewpointName& one : list) viewpoints_.push_back(one.node.get());
  viewpointsText_ = viewpointsText(list);
}

void Reports::tell(double now, bool changes, Host& host) {
  if (now < next_ || pages_.count() == 0) return;
  takeMessages(now);
  readViewpoints(now);
  for (const auto& [number, page] : pages_.all()) {
    Told& told = told_[number];
    if (told.viewpoints != viewpointsText_)
      host.sendText(number, "viewpoints", told.viewpoints = viewpointsText_);
    if (std::string state = stateOf(page, now); told.state != state)
      host.sendText(number, "state", told.state = std::move(state));
  }
  std::erase_if(notices_, [&](const auto& one) { return now >= one.second.ends; });
  next_ = now + (changes || !notices_.empty() ? interval : quietInterval);
}

} // namespace vv::server
