#include "scene/history.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "openrt/frame.h"

namespace openrt {
namespace {

// Returns the settings of the frame in a commit; null if it does not change them.
const edit::FrameSettingsT* settingsIn(const Commit& commit) {
  const auto& edits = commit.edits.edits;
  for (size_t i = edits.size(); i-- > 0;)
    if (const auto* settings = edits[i] ? edits[i]->any.AsFrameSettings() : nullptr)
      return settings;
  return nullptr;
}

// Returns whether a commit may move anything.
bool movesAnything(const Commit& commit) {
  using edit::Any;
  return std::any_of(commit.edits.edits.begin(), commit.edits.edits.end(), [](const auto& edit) {
    const Any type = edit ? edit->any.type : Any::NONE;
    return type == Any::Object || type == Any::DeleteObject || type == Any::Instance ||
           type == Any::DeleteInstance;
  });
}

} // namespace

const SceneHistory::View& SceneHistory::current() const {
  static const View none;
  const auto found = views_.find(view_);
  return found == views_.end() ? none : found->second;
}

// The channel may be asked for by the same commit that moves things. So its settings, which stand
// at its end, are read before anything is changed. A view whose last frame lacks the channel notes
// nothing until its next frame; if others move things meanwhile, it begins anew.
void SceneHistory::begin(const Commit& commit) {
  if (std::exchange(framed_, false)) {
    View& before = views_[view_];
    before.history.beginAnew();
    before.last = number_++;
    std::erase_if(views_, [&](const auto& one) {
      return one.first != view_ && number_ - one.second.last > maxFramesBetween;
    });
  }
  if (const auto* settings = settingsIn(commit)) {
    view_ = settings->view;
    views_[view_].watches = settings->channels & RT_MOTION;
  }
  if (!watches() && views_.contains(view_)) views_[view_].history.forget();
  if (views_.size() > 1 && movesAnything(commit))
    std::erase_if(views_,
                  [&](const auto& one) { return one.first != view_ && !one.second.watches; });
  records_ =
      std::any_of(views_.begin(), views_.end(), [](const auto& one) { return one.second.watches; });
}

template <class F> void SceneHistory::forEachWatching(const F& f) {
  for (auto& [number, view] : views_)
    if (view.watches) f(view.history);
}

void SceneHistory::changeInstance(uint32_t id, const Instance& before) {
  forEachWatching([&](ViewHistory& view) { view.changeInstance(id, before); });
}

void SceneHistory::addInstance(uint32_t id) {
  forEachWatching([&](ViewHistory& view) { view.addInstance(id); });
}

void SceneHistory::changeObject(uint32_t id, const FormerGeometries& before) {
  forEachWatching([&](ViewHistory& view) { view.changeObject(id, before); });
}

void SceneHistory::addObject(uint32_t id) {
  forEachWatching([&](ViewHistory& view) { view.addObject(id); });
}

void SceneHistory::finish(const Scene& scene, const Commit& commit) {
  framed_ = commit.edits.render;
  if (watches()) views_[view_].history.match(scene);
}

} // namespace openrt
