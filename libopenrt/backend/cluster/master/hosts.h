// hosts.h: the workers that a user names: a list, or a file of them. Pure functions. [any]
#pragma once

#include <string>
#include <vector>

namespace openrt::cluster {

// Entries of the form @FILE are replaced by those that the file lists, one a line; what follows a #
// is a comment. Throws ClusterError if a file cannot be read, or names nobody.
std::vector<std::string> readHosts(const std::vector<std::string>& entries);

} // namespace openrt::cluster
