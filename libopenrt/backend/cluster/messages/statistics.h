// statistics.h: the statistics of a scene as they travel: named numbers and texts, one for each
// member of the groups of RTstats. Names are part of the protocol (docs/protocol.md): a new member
// needs a new line here, and no name changes its meaning. [any]
#pragma once

#include "messages_generated.h"
#include "openrt/frame.h"

namespace openrt::cluster {

// Calls f(name, member) for all members of RTstats except size, in their order.
template <class Stats, class F> void forEachStatistic(Stats& s, F&& f) {
  f("frame", s.frame);
  f("scene.triangles", s.scene.triangles);
  f("scene.uniqueTriangles", s.scene.uniqueTriangles);
  f("scene.objects", s.scene.objects);
  f("scene.instances", s.scene.instances);
  f("scene.lights", s.scene.lights);
  f("scene.textures", s.scene.textures);
  f("rejected.primitives", s.rejected.primitives);
  f("rejected.instances", s.rejected.instances);
  f("rejected.rays", s.rejected.rays);
  f("rejected.hits", s.rejected.hits);
  f("time.commit", s.time.commit);
  f("time.build", s.time.build);
  f("time.render", s.time.render);
  f("rays.camera", s.rays.camera);
  f("rays.shadow", s.rays.shadow);
  f("rays.secondary", s.rays.secondary);
  f("bvh.bytes", s.bvh.bytes);
  f("bvh.objectBuilds", s.bvh.objectBuilds);
  f("bvh.topLevelBuilds", s.bvh.topLevelBuilds);
  f("machine.threads", s.machine.threads);
  f("machine.isa", s.machine.isa);
  f("machine.kernel", s.machine.kernel);
  f("transport.chosen", s.transport.chosen);
  f("transport.reason", s.transport.reason);
  f("transport.leavesOut", s.transport.leavesOut);
  f("transport.unreachedLights", s.transport.unreachedLights);
  f("error.mean", s.error.mean);
  f("error.meanInterval", s.error.meanInterval);
  f("error.halfWidth", s.error.halfWidth);
  f("error.p99", s.error.p99);
  f("error.level", s.error.level);
  f("error.pixels", s.error.pixels);
  f("error.trusted", s.error.trusted);
  f("error.unmet", s.error.unmet);
  f("error.method", s.error.method);
  f("leftOut.cutByDepth", s.leftOut.cutByDepth);
  f("leftOut.cutByEnergy", s.leftOut.cutByEnergy);
  f("leftOut.clipped", s.leftOut.clipped);
  f("leftOut.shaderFaults", s.leftOut.shaderFaults);
  f("cluster.workers", s.cluster.workers);
  f("cluster.tilesRemote", s.cluster.tilesRemote);
  f("cluster.tilesLocal", s.cluster.tilesLocal);
  f("cluster.reissued", s.cluster.reissued);
  f("cluster.duplicates", s.cluster.duplicates);
  f("cluster.bytesSent", s.cluster.bytesSent);
  f("cluster.bytesReceived", s.cluster.bytesReceived);
  f("outdated", s.outdated);
}

using StatisticsVector = flatbuffers::Vector<flatbuffers::Offset<wire::Statistic>>;

// Writes the statistics that are neither 0 nor empty.
flatbuffers::Offset<StatisticsVector> writeStatistics(flatbuffers::FlatBufferBuilder& builder,
                                                      const RTstats& stats);
// Throws BadMessage if there are too many statistics, or too long texts. Copies nothing.
void checkStatistics(const StatisticsVector* from);
// Reads statistics that have been checked. Unknown names are ignored, missing ones are 0. Throws
// BadMessage if a count is negative or NaN.
RTstats readStatistics(const StatisticsVector* from);

} // namespace openrt::cluster
