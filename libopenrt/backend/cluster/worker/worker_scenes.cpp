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
  counts_.scenes++;
  newest_ = base_ + m.epoch;
  unanswered_.emplace_back(newest_, m.edits.size());
  unansweredBytes_ += m.edits.size();
  message::Need need{.epoch = m.epoch};
  PendingScene& pending = pendingScenes_.emplace_back();
  pending.scene = std::move(m);
  for (const message::ArrayName& name : pending.scene.arrays) {
    if (pending.arrays.contains(name.hash) || pending.missing.contains(name.hash)) continue;
    if (ArrayPtr array = cached(name)) {
      pending.arrays.emplace(name.hash, std::move(array));
      continue;
    }
    pending.missing.insert(name.hash);
    if (streams_.try_emplace(name.hash, name.hash, name.bytes, options_.folder).second)
      need.arrays.push_back(name.hash);
  }
  sendMessage(std::move(need));
  applyPendingScenes();
}

// Returns an array that was kept in memory or in the folder; null if it must be sent.
ArrayPtr Worker::cached(const message::ArrayName& name) {
  if (ArrayPtr array = cache_.find(name.hash, name.bytes)) {
    counts_.inMemory.add(name.bytes);
    return array;
  }
  ArrayPtr array = fromFolder(name);
  if (array) cache_.put(name.hash, array);
  return array;
}

ArrayPtr Worker::fromFolder(const message::ArrayName& name) {
  if (!options_.folder || name.bytes < limits::keptArrayBytes) return nullptr;
  ArrayPtr array = options_.folder->load(name.hash, name.bytes);
  if (array) counts_.inFolder.add(name.bytes);
  return array;
}

// Gives an array to the scenes that wait for it. Null: they cannot be made.
void Worker::arrived(const Hash& hash, const ArrayPtr& array) {
  if (array) cache_.put(hash, array);
  for (PendingScene& pending : pendingScenes_)
    if (pending.missing.erase(hash)) pending.arrays.emplace(hash, array);
  applyPendingScenes();
}

void Worker::sayGot(std::vector<Hash> arrays, bool failed, bool kept) {
  if (arrays.empty() || options_.self.share == 0) return; // such masters do not ask
  message::Got m;
  m.arrays = std::move(arrays);
  m.failed = failed;
  m.kept = kept;
  sendMessage(std::move(m));
}

// Returns whether this worker can send the array to others. One that is larger than the folder may
// be is not kept.
bool Worker::isKept(const Hash& hash, const Array& array) const {
  return options_.folder && options_.folder->open(hash, array.size()).has_value();
}

// Another worker has these arrays. The folder may have them meanwhile, if it uses the same one.
void Worker::source(const message::Source& m) {
  if (!link_.fetch) return bad("this worker asks no other one for arrays");
  std::vector<message::ArrayName> wanted;
  std::vector<Hash> found;
  for (const message::ArrayName& name : m.arrays) {
    const auto stream = streams_.find(name.hash);
    if (stream == streams_.end()) continue; // it has come already
    if (stream->second.bytes() != name.bytes) return bad("a source is of an array of another size");
    if (stream->second.begun()) continue; // the master sends it
    const ArrayPtr array = fromFolder(name);
    if (!array) {
      wanted.push_back(name);
      continue;
    }
    streams_.erase(stream);
    fetched_.insert(name.hash);
    found.push_back(name.hash);
    arrived(name.hash, array);
  }
  sayGot(std::move(found), false, true);
  if (!wanted.empty()) link_.fetch(m.address, std::move(wanted));
}

void Worker::fetched(const Hash& hash, ArrayPtr array) {
  const auto stream = streams_.find(hash);
  if (stream == streams_.end()) return; // it came from the master, or a former one wanted it
  if (array && stream->second.bytes() != array->size()) array = nullptr;
  if (!array && stream->second.begun()) return; // the master sends it
  sayGot({hash}, !array, array && isKept(hash, *array));
  if (!array) return;
  counts_.sentByWorkers.add(array->size());
  if (!stream->second.begun()) {
    streams_.erase(stream);
    fetched_.insert(hash);
  }
  arrived(hash, array);
}

void Worker::piece(const message::Piece& m) {
  const auto stream = streams_.find(m.hash);
  if (stream == streams_.end()) {
    if (fetched_.contains(m.hash)) return;
    return bad("a piece is of an array that was not needed");
  }
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
  if (array) {
    counts_.sentByMaster.add(array->size());
    if (array->size() >= limits::keptArrayBytes) sayGot({m.hash}, false, isKept(m.hash, *array));
  } else {
    bad(why); // scenes that use it cannot be made
  }
  arrived(m.hash, array);
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
