// checks.cpp: runs the check of each kind of message, and has those checks that are too large for a
// row of the table (kinds.h). They run after the flatbuffer has been verified and before anything
// is copied, so they bound the memory that a message takes. [any]
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "backend/cluster/messages/messages.h"
#include "backend/cluster/messages/statistics.h"
#include "scene/transports.h"

namespace openrt::cluster {
namespace {

void check(const wire::Ready& m, const Frames&) {
  demand(isTransport(m.transport()), "an unknown transport");
  checkStatistics(m.stats());
}

void check(const wire::Result& m, const Frames&) {
  demand(m.seconds() >= 0 && std::isfinite(m.seconds()), "a result after an impossible time");
  demand(m.bytes() <= limits::resultBytes, "the result is too large");
  demand(!m.faults() || m.faults()->size() <= limits::libraries, "too many faults");
}

void check(const wire::Welcome& m, const Frames&) {
  demand(m.heartbeat() >= 0.01f && m.heartbeat() <= 60 && m.silence() >= 0.02f &&
             m.silence() <= 600 && m.heartbeat() < m.silence(),
         "impossible heartbeats");
}

void check(const wire::Scene& m, const Frames& frames) {
  demand(m.epoch() != 0 && m.epoch() <= limits::epochs,
         "a scene has no number, or too large a one");
  demand(bytesOf(frames) - frames[0].size() <= limits::editBytes, "too many edits");
  demandAligned(m.arrays());
  if (m.arrays()) {
    uint64_t sum = 0;
    for (const wire::ArrayName* name : *m.arrays()) {
      demand(name->id() != 0 && name->bytes() <= limits::arrayBytes,
             "an array has no number or is too large");
      sum += name->bytes();
      demand(sum <= limits::sceneBytes, "the arrays are too large together");
    }
  }
  if (m.libraries()) {
    demand(m.libraries()->size() <= limits::libraries, "too many libraries");
    for (const wire::Library* library : *m.libraries())
      demand(library->hash() != nullptr, "a hash is missing");
  }
}

void check(const wire::Piece& m, const Frames& frames) {
  demand(m.hash() != nullptr, "a hash is missing");
  demand(m.bytes() <= limits::arrayBytes && plausible(m.bytes(), m.stored()),
         "an array of an impossible size");
  demand(m.offset() < m.stored() && m.offset() % pieceBytes == 0 &&
             frames[1].size() == std::min<uint64_t>(pieceBytes, m.stored() - m.offset()),
         "a piece does not fit its array");
}

void checkSizes(const flatbuffers::Vector<const wire::ArrayName*>* arrays) {
  demandAligned(arrays);
  if (!arrays) return;
  for (const wire::ArrayName* name : *arrays)
    demand(name->bytes() <= limits::arrayBytes, "an array is too large");
}

void check(const wire::Source& m, const Frames&) { checkSizes(m.arrays()); }

void check(const wire::Fetch& m, const Frames&) {
  checkSizes(m.arrays());
  demand(!m.arrays() || m.arrays()->size() <= limits::arraysAsked, "too many arrays are asked for");
}

void check(const wire::Jobs& m, const Frames&) {
  if (!m.jobs()) return;
  demandAligned(m.jobs());
  demand(m.jobs()->size() <= limits::jobs, "too many jobs");
  for (const wire::Job* job : *m.jobs()) {
    demand(job->kind() <= uint8_t(Job::Kind::light), "an unknown kind of job");
    demand(job->count() >= 1 && job->shift() <= 31 &&
               uint64_t(job->first()) + job->count() <= uint64_t(1) << 32,
           "an impossible job");
  }
}

} // namespace

void checkBody(const wire::Header& header, const Frames& frames) {
  forEachKind([&](auto kind) {
    using Kind = decltype(kind);
    if (header.any_type() != kind.any) return;
    const auto* table = header.any_as<typename Kind::Table>();
    demand(table != nullptr, "the message has no content");
    if constexpr (std::is_same_v<typename Kind::Check, ByFunction>)
      check(*table, frames);
    else
      Kind::Check::check(*table, frames);
  });
}

} // namespace openrt::cluster
