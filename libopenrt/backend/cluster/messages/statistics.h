// statistics.h: the statistics of a scene as they travel: named numbers and texts, one for each
// member of RTstats. Names are part of the protocol (docs/protocol.md): a new member needs a new
// line here, and no name changes its meaning. [any]
#pragma once

#include "messages_generated.h"
#include "openrt/frame.h"

namespace openrt::cluster {

// Calls f(name, member) for all members of RTstats except size, in their order.
template <class Stats, class F> void forEachStatistic(Stats& s, F&& f) {
  f("triangles", s.triangles);
  f("uniqueTriangles", s.uniqueTriangles);
  f("objects", s.objects);
  f("instances", s.instances);
  f("lights", s.lights);
  f("textures", s.textures);
  f("degenerate", s.degenerate);
  f("rejectedRays", s.rejectedRays);
  f("rejectedInstances", s.rejectedInstances);
  f("cameraRays", s.cameraRays);
  f("shadowRays", s.shadowRays);
  f("secondaryRays", s.secondaryRays);
  f("commitSeconds", s.commitSeconds);
  f("buildSeconds", s.buildSeconds);
  f("renderSeconds", s.renderSeconds);
  f("bvhBytes", s.bvhBytes);
  f("objectBuilds", s.objectBuilds);
  f("topLevelBuilds", s.topLevelBuilds);
  f("threads", s.threads);
  f("isa", s.isa);
  f("kernel", s.kernel);
  f("errorMean", s.errorMean);
  f("errorMeanInterval", s.errorMeanInterval);
  f("errorHalfWidth", s.errorHalfWidth);
  f("errorP99", s.errorP99);
  f("errorLevel", s.errorLevel);
  f("errorPixels", s.errorPixels);
  f("errorTrusted", s.errorTrusted);
  f("errorMethod", s.errorMethod);
  f("transport", s.transport);
  f("transportReason", s.transportReason);
  f("cutByDepth", s.cutByDepth);
  f("cutByEnergy", s.cutByEnergy);
  f("clipped", s.clipped);
  f("unreachedLights", s.unreachedLights);
  f("shaderFaults", s.shaderFaults);
  f("wrongHits", s.wrongHits);
  f("frame", s.frame);
  f("workers", s.workers);
  f("tilesRemote", s.tilesRemote);
  f("tilesLocal", s.tilesLocal);
  f("reissued", s.reissued);
  f("duplicates", s.duplicates);
  f("bytesSent", s.bytesSent);
  f("bytesReceived", s.bytesReceived);
  f("transportLeavesOut", s.transportLeavesOut);
  f("errorUnmet", s.errorUnmet);
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
