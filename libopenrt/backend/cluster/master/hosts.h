// hosts.h: reads the user's list of workers, given directly or in a file. Pure functions. [any]
#pragma once

#include <string>
#include <vector>

namespace openrt::cluster {

// Replaces entries of the form @FILE by the entries listed in that file, one per line; # starts a
// comment. Throws ClusterError if a file cannot be read or lists no worker.
std::vector<std::string> readHosts(const std::vector<std::string>& entries);

} // namespace openrt::cluster
