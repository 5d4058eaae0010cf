#include "backend/cluster/master/scene_log.h"

#include <algorithm>

#include "openrt/frame.h"
#include "scene/whole_scene.h"

namespace openrt::cluster {

void SceneLog::add(Epoch epoch, std::shared_ptr<const Commit> commit) {
  for (const auto& entry : commit->edits.edits)
    if (const auto* settings = entry ? entry->any.AsFrameSettings() : nullptr) frame_ = *settings;
  log_.push_back({epoch, packer_.pack(std::move(commit)), (frame_.channels & RT_MOTION) != 0});
  bytes_ += log_.back().parcel->bytes;
}

void SceneLog::dropFirst() {
  bytes_ -= log_.front().parcel->bytes;
  gone_ = log_.front().epoch;
  log_.pop_front();
}

// A worker that joins at a frame with RT_MOTION must know the scene of the frame before. So that
// one is kept, and the worker gets the commits after it, too.
Epoch SceneLog::baseFor(Epoch epoch) const {
  const auto after = std::find_if(log_.begin(), log_.end(),
                                  [epoch](const Entry& entry) { return entry.epoch > epoch; });
  if (after == log_.begin() || !std::prev(after)->motion) return epoch;
  for (auto entry = std::prev(after); entry != log_.begin();)
    if ((--entry)->parcel->commit->edits.render) return entry->epoch;
  return base_;
}

void SceneLog::settle(Epoch epoch) {
  const Epoch base = baseFor(epoch);
  for (const Entry& entry : log_) {
    if (entry.epoch <= base_ || entry.epoch > base) continue;
    scene_.apply(*entry.parcel->commit);
    base_ = entry.epoch;
    whole_.reset();
  }
  while (!log_.empty() && log_.front().epoch <= base_ &&
         (log_.size() > maxCommits || bytes_ > maxBytes))
    dropFirst();
}

void SceneLog::trim(Epoch epoch) {
  while (!log_.empty() && log_.front().epoch <= std::min(base_, epoch)) dropFirst();
}

std::vector<SceneLog::Step> SceneLog::steps(Epoch has, Epoch wanted) {
  std::vector<Step> result;
  const bool fresh = has == 0;
  if (has < gone_ || (fresh && base_ > 0)) {
    // The only commit is the whole scene.
    const bool onlyOne = gone_ == 0 && !log_.empty() && log_.front().epoch == base_;
    if (!whole_) whole_ = onlyOne ? log_.front().parcel : packer_.pack(wholeScene(scene_));
    result.push_back({base_, whole_, true});
    has = base_;
  }
  for (const Entry& entry : log_)
    if (entry.epoch > has && entry.epoch <= wanted)
      result.push_back({entry.epoch, entry.parcel, fresh && result.empty()});
  return result;
}

} // namespace openrt::cluster
