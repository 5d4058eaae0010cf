#include "backend/cluster/messages/native.h"

#include "messages_generated.h"

namespace flatbuffers {

using namespace openrt;

wire::Hash Pack(const cluster::Hash& hash) { return {hash.low, hash.high}; }
cluster::Hash UnPack(const wire::Hash& hash) { return {hash.low(), hash.high()}; }

wire::ArrayName Pack(const cluster::message::ArrayName& name) {
  return {name.id, name.bytes, Pack(name.hash)};
}
cluster::message::ArrayName UnPack(const wire::ArrayName& name) {
  return {name.id(), name.bytes(), UnPack(name.hash())};
}

wire::Job Pack(const cluster::LeasedJob& leased) {
  const Job& job = leased.job;
  return {leased.lease, job.replicates.seed, job.number,  job.first,
          job.count,    uint8_t(job.kind),   job.centred, uint8_t(job.replicates.shift)};
}
cluster::LeasedJob UnPack(const wire::Job& job) {
  return {job.lease(),
          {Job::Kind(job.kind()),
           job.centred(),
           job.number(),
           job.first(),
           job.count(),
           {job.seed(), job.shift()}}};
}

} // namespace flatbuffers
