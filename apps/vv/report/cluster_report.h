// cluster_report.h: Reports the worker machines: their number in the progress line, those that join
// or leave, and the work that each has done. [main thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"

namespace vv {

// Starts to connect to the workers that the options name. Errors in the options are reported before
// a world is read, and workers join meanwhile. Throws Failure.
void joinCluster(Options& options);

// Returns "3 workers", "2 of 3 workers" or "no worker yet"; empty without a cluster.
std::string workersText(const picture::Cluster* cluster);
std::string workersText(const std::vector<RTworker>& workers);

// Selects the engine's messages about its workers: warnings by default, all with verbose, errors
// with quiet.
std::vector<std::string> clusterMessageLines(const std::vector<picture::ClusterMessage>& notes,
                                             bool verbose, bool quiet);

// Returns a table with one line per machine; empty without a cluster.
std::vector<std::string> clusterLines(const picture::RenderResult& result);

} // namespace vv
