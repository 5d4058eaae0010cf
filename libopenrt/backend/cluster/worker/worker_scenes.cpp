// worker_scenes.cpp: the scenes of a worker's session: which arrays are cached, which must be sent,
// and the commit made from them. Received data is validated like a recording. [worker]
#include <algorithm>
#include <stdexcept>

#include "backend/cluster/worker/worker.h"
#include "backend/record/edits_bytes.h"
#include "backend/record/validator.h"

namespace openrt::cluster {

void Worker::refuse(Epoch epoch, const std::string& why) {
  broken_ = why;
  std::erase_if(unanswered_, [&](const auto& scene) {
    if (scene.first != base_ + epoch) return false;
    unansweredBytes_ -= scene.second;
    return true;
  });
  sendMessage(message::Failed{.epoch = epoch, .why = why});
}

void Worker::scene(message::Scene&& m) {
  if (base_ + m.epoch <= newest_) return bad("the scene is older than the last");
  if (unanswered_.size() >= limits::scenesAtOnce ||
      unansweredBytes_ + m.edits.size() > limits::scenesBytes)
    return giveUp("it sends more scenes than this worker can prepare");
  newest_ = base_ + m.epoch;
  unanswered_.emplace_back(newest_, m.edits.size());
  unansweredBytes_ += m.edits.size();
  message::Need need{.epoch = m.epoch};
  PendingScene& pending = pendingScenes_.emplace_back();
  pending.scene = std::move(m);
  for (const message::ArrayName& name : pending.scene.arrays) {
    if (pending.arrays.contains(name.hash) || pending.missing.contains(name.hash)) continue;
    if (ArrayPtr array = cache_.find(name.hash, name.bytes)) {
      pending.arrays.emplace(name.hash, std::move(array));
      continue;
    }
    pending.missing.insert(name.hash);
    if (streams_.try_emplace(name.hash, name.hash, name.bytes).second)
      need.arrays.push_back(name.hash);
  }
  sendMessage(std::move(need));
  applyPendingScenes();
}

void Worker::piece(const message::Piece& m) {
  const auto stream = streams_.find(m.hash);
  if (stream == streams_.end()) return bad("a piece is of an array that was not needed");
  if (!stream->second.begun() && begun_ >= limits::arraysAtOnce)
    return bad("there are pieces of too many arrays at once");
  begun_ += stream->second.begun() ? 0 : 1;
  std::string why;
  try {
    why = stream->second.put(m);
  } catch (const std::bad_alloc&) {
    why = "no memory for an array of " + std::to_string(m.bytes) + " bytes";
  }
  if (why.empty() && !stream->second.complete()) return;
  const ArrayPtr array = why.empty() ? stream->second.take() : nullptr;
  if (why.empty() && !array) why = "an array has a wrong checksum";
  streams_.erase(stream);
  begun_--;
  if (!array) { // scenes that use it cannot be made
    bad(why);
    for (PendingScene& pending : pendingScenes_)
      if (pending.missing.erase(m.hash)) pending.arrays.emplace(m.hash, nullptr);
    return applyPendingScenes();
  }
  cache_.put(m.hash, array);
  for (PendingScene& pending : pendingScenes_)
    if (pending.missing.erase(m.hash)) pending.arrays.emplace(m.hash, array);
  applyPendingScenes();
}

void Worker::prepare(const message::Prepare& m) {
  if (m.epoch == 0 || m.epoch > newest_ - base_) return bad("the scene to prepare has not arrived");
  if (pendingScenes_.empty()) {
    if (!broken_.empty()) return sendMessage(message::Failed{.epoch = m.epoch, .why = broken_});
    return executor_.prepare(base_ + m.epoch);
  }
  if (pendingScenes_.size() >= 2 * limits::scenesAtOnce)
    return giveUp("it asks for more scenes than this worker can prepare");
  PendingScene& pending = pendingScenes_.emplace_back();
  pending.scene.epoch = m.epoch;
  pending.prepareOnly = true;
}

void Worker::applyPendingScenes() {
  while (!pendingScenes_.empty() && pendingScenes_.front().missing.empty()) {
    PendingScene next = std::move(pendingScenes_.front());
    pendingScenes_.pop_front();
    try {
      apply(next);
    } catch (const std::bad_alloc&) {
      refuse(next.scene.epoch, "out of memory");
    } catch (const std::exception& e) { refuse(next.scene.epoch, e.what()); }
  }
  if (pendingScenes_.empty()) cache_.trim();
}

void Worker::apply(PendingScene& pending) {
  const message::Scene& m = pending.scene;
  if (pending.prepareOnly) {
    if (!broken_.empty()) return refuse(m.epoch, broken_);
    return executor_.prepare(base_ + m.epoch);
  }
  if (m.whole) {
    broken_.clear();
    validator_ = std::make_unique<CommitValidator>(options_.shaders);
  }
  if (!broken_.empty()) return refuse(m.epoch, broken_);
  if (const std::string problem = libraries_.problem(m.libraries); !problem.empty())
    throw std::runtime_error(problem);
  auto commit = std::make_shared<Commit>();
  for (const message::ArrayName& name : m.arrays) {
    const ArrayPtr& array = pending.arrays.at(name.hash);
    if (!array) throw std::runtime_error("an array did not arrive intact");
    if (array->size() != name.bytes || !commit->arrays.emplace(name.id, array).second)
      throw std::runtime_error("array " + std::to_string(name.id) +
                               " appears twice, or with two sizes");
  }
  unpackEdits(m.edits, commit->edits);
  validator_->check(*commit);
  executor_.scene(base_ + m.epoch, std::move(commit), m.whole, m.prepare);
}

} // namespace openrt::cluster
