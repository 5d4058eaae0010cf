// counts.h: what a worker has done, counted for `openrt-worker --metrics`. Any thread adds and
// reads.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "backend/cluster/messages/messages.h"

namespace openrt::cluster {

struct WorkerCounts {
  using Count = std::atomic<uint64_t>;
  struct Arrays { // arrays that scenes have used, and their unpacked bytes
    Count number{0}, bytes{0};
    void add(uint64_t size) {
      number++;
      bytes += size;
    }
  };
  Count masters{0}, scenes{0}, jobs{0};
  std::atomic<double> seconds{0}; // in jobs, summed over threads
  Count cameraRays{0}, shadowRays{0}, secondaryRays{0};
  Count fromMaster{0}, toMaster{0}, fromWorkers{0}, toWorkers{0}; // bytes on the wires
  Arrays inMemory, inFolder, sentByMaster, sentByWorkers;
  Count failedFetches{0};
};

// Values of the moment.
struct WorkerGauges {
  uint32_t threads = 0;
  bool serving = false;
  uint64_t damagedFiles = 0; // counted by the folder
};

// Returns the counts in the text format of Prometheus (version 0.0.4).
std::string metricsText(const WorkerCounts& counts, const WorkerGauges& gauges,
                        const message::Hello& self);

} // namespace openrt::cluster
