// worker_scenes.cpp: scenes of a worker's session: which arrays are here, which must come, and the
// commit that becomes of it. What comes is checked as a recording is. [worker]
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
  say(message::Failed{epoch, why});
}

void Worker::scene(message::Scene&& m) {
  if (base_ + m.epoch <= newest_) return bad("a scene that is older than the last");
  if (unanswered_.size() >= limits::scenesAtOnce ||
      unansweredBytes_ + m.edits.size() > limits::scenesBytes)
    return giveUp("it sends more scenes than can be made");
  newest_ = base_ + m.epoch;
  unanswered_.emplace_back(newest_, m.edits.size());
  unansweredBytes_ += m.edits.size();
  message::Need need{m.epoch, {}};
  Coming& coming = coming_.emplace_back();
  coming.scene = std::move(m);
  for (const message::ArrayName& name : coming.scene.arrays) {
    if (coming.arrays.contains(name.hash) || coming.missing.contains(name.hash)) continue;
    if (ArrayPtr array = cache_.find(name.hash, name.bytes)) {
      coming.arrays.emplace(name.hash, std::move(array));
      continue;
    }
    coming.missing.insert(name.hash);
    if (streams_.try_emplace(name.hash, name.hash, name.bytes).second)
      need.arrays.push_back(name.hash);
  }
  say(std::move(need));
  applyComing();
}

void Worker::piece(const message::Piece& m) {
  const auto stream = streams_.find(m.hash);
  if (stream == streams_.end()) return bad("a piece of an array that nobody asked for");
  if (!stream->second.begun() && begun_ >= limits::arraysAtOnce)
    return bad("pieces of too many arrays at once");
  begun_ += stream->second.begun() ? 0 : 1;
  std::string why;
  try {
    why = stream->second.put(m);
  } catch (const std::bad_alloc&) {
    why = "no memory for an array of " + std::to_string(m.bytes) + " bytes";
  }
  if (why.empty() && !stream->second.complete()) return;
  const ArrayPtr array = why.empty() ? stream->second.take() : nullptr;
  if (why.empty() && !array) why = "an array with a wrong checksum";
  streams_.erase(stream);
  begun_--;
  if (!array) { // scenes without it cannot be made
    bad(why);
    for (Coming& coming : coming_)
      if (coming.missing.erase(m.hash)) coming.arrays.emplace(m.hash, nullptr);
    return applyComing();
  }
  cache_.put(m.hash, array);
  for (Coming& coming : coming_)
    if (coming.missing.erase(m.hash)) coming.arrays.emplace(m.hash, array);
  applyComing();
}

void Worker::prepare(const message::Prepare& m) {
  if (m.epoch == 0 || m.epoch > newest_ - base_)
    return bad("a scene that has not come is to be prepared");
  if (coming_.empty()) {
    if (!broken_.empty()) return say(message::Failed{m.epoch, broken_});
    return machine_.prepare(base_ + m.epoch);
  }
  if (coming_.size() >= 2 * limits::scenesAtOnce)
    return giveUp("it asks for more scenes than can be made");
  Coming& coming = coming_.emplace_back();
  coming.scene.epoch = m.epoch;
  coming.prepareOnly = true;
}

void Worker::applyComing() {
  while (!coming_.empty() && coming_.front().missing.empty()) {
    Coming next = std::move(coming_.front());
    coming_.pop_front();
    try {
      apply(next);
    } catch (const std::bad_alloc&) {
      refuse(next.scene.epoch, "out of memory");
    } catch (const std::exception& e) { refuse(next.scene.epoch, e.what()); }
  }
  if (coming_.empty()) cache_.trim();
}

void Worker::apply(Coming& coming) {
  const message::Scene& m = coming.scene;
  if (coming.prepareOnly) {
    if (!broken_.empty()) return refuse(m.epoch, broken_);
    return machine_.prepare(base_ + m.epoch);
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
    const ArrayPtr& array = coming.arrays.at(name.hash);
    if (!array) throw std::runtime_error("an array did not come as it should");
    if (array->size() != name.bytes || !commit->arrays.emplace(name.id, array).second)
      throw std::runtime_error("array " + std::to_string(name.id) + " twice, or of two sizes");
  }
  unpackEdits(m.edits, commit->edits);
  validator_->check(*commit);
  machine_.scene(base_ + m.epoch, std::move(commit), m.whole, m.prepare);
}

} // namespace openrt::cluster
