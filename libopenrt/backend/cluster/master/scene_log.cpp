#include "backend/cluster/master/scene_log.h"

#include <algorithm>
#include <cstddef>
#include <set>

#include "openrt/frame.h"
#include "scene/history.h"
#include "scene/whole_scene.h"

namespace openrt::cluster {

void SceneLog::add(Epoch epoch, std::shared_ptr<const Commit> commit) {
  for (const auto& entry : commit->edits.edits)
    if (const auto* settings = entry ? entry->any.AsFrameSettings() : nullptr) frame_ = *settings;
  if (commit->edits.render)
    frames_.push_back({epoch, frame_.view, (frame_.channels & RT_MOTION) != 0});
  log_.push_back({epoch, packer_.pack(std::move(commit))});
  bytes_ += log_.back().parcel->bytes;
}

void SceneLog::dropFirst() {
  bytes_ -= log_.front().parcel->bytes;
  gone_ = log_.front().epoch;
  log_.pop_front();
}

// Returns the epoch of the oldest frame to which the motion of the frame of `epoch`, or of a later
// one, may refer (SceneHistory): the last one of each view, and in the view of that frame, if it
// has RT_MOTION, the one before it.
Epoch SceneLog::baseFor(Epoch epoch) const {
  auto frame = std::find_if(frames_.rbegin(), frames_.rend(),
                            [epoch](const Frame& one) { return one.epoch <= epoch; });
  if (frame == frames_.rend()) return epoch;
  const Frame& own = *frame;
  std::set<uint32_t> found;
  Epoch base = epoch;
  if (!own.motion)
    found.insert(own.view);
  else if (own.epoch == epoch)
    ++frame;
  for (uint64_t passed = 0; frame != frames_.rend() && passed <= maxFramesBetween;
       ++frame, ++passed)
    if (found.insert(frame->view).second) base = frame->epoch;
  return base;
}

// Forgets the frames that baseFor() needs neither for the frame of `epoch` nor for later ones.
void SceneLog::dropFrames(Epoch epoch) {
  const auto before = std::count_if(frames_.begin(), frames_.end(),
                                    [epoch](const Frame& one) { return one.epoch < epoch; });
  for (auto kept = before; kept > std::ptrdiff_t(maxFramesBetween) + 1; --kept) frames_.pop_front();
}

void SceneLog::settle(Epoch epoch) {
  const Epoch base = baseFor(epoch);
  dropFrames(epoch);
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
