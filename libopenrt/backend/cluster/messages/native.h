// native.h: the types that flatc's object API uses for parts of messages.fbs instead of its own,
// and how they are converted. Only the header that flatc makes and kinds.h include it. [any]
#pragma once

#include <compare>
#include <cstdint>

#include "backend/cluster/messages/text.h"
#include "backend/cluster/worker/worker_core.h"

namespace openrt::cluster {

struct Hash {
  uint64_t low = 0, high = 0;
  auto operator<=>(const Hash&) const = default;
};

namespace message {
struct ArrayName {
  ArrayId id = 0;
  uint64_t bytes = 0;
  Hash hash;
};
} // namespace message

} // namespace openrt::cluster

namespace openrt::wire {
struct Hash;
struct ArrayName;
struct Job;
} // namespace openrt::wire

// The object API calls these functions and expects them here. A Job that is unpacked has been
// checked (checks.cpp).
namespace flatbuffers {
openrt::wire::Hash Pack(const openrt::cluster::Hash& hash);
openrt::cluster::Hash UnPack(const openrt::wire::Hash& hash);
openrt::wire::ArrayName Pack(const openrt::cluster::message::ArrayName& name);
openrt::cluster::message::ArrayName UnPack(const openrt::wire::ArrayName& name);
openrt::wire::Job Pack(const openrt::cluster::LeasedJob& job);
openrt::cluster::LeasedJob UnPack(const openrt::wire::Job& job);
} // namespace flatbuffers
