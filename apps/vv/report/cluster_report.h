// cluster_report.h: what vv tells of the machines that help: in the progress line, of those that
// come and go, and of the work that each has done. [main thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"

namespace vv {

// Begins to call the workers that the options name: what is wrong with these is said before a world
// is read, and workers join meanwhile. Throws Failure.
void joinCluster(Options& options);
// Of a picture that could not be made.
int exitCodeOf(const picture::RenderError& error);

// "3 workers", "2 of 3 workers", "no worker yet"; empty without a cluster.
std::string workersText(const picture::Cluster* cluster);
std::string workersText(const std::vector<RTworker>& workers);

// What is to be said of what the engine tells of its workers: warnings; with verbose everything,
// with quiet errors.
std::vector<std::string> noteLines(const std::vector<picture::ClusterNote>& notes, bool verbose,
                                   bool quiet);

// A table: a line for each machine; empty without a cluster.
std::vector<std::string> clusterLines(const picture::RenderResult& result);

} // namespace vv
