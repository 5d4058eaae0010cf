// hosts.cpp: see hosts.h.
#include "backend/cluster/hosts.h"

#include <fstream>

#include "backend/backend.h"

namespace openrt::cluster {
namespace {

std::string trimmed(std::string line) {
  line.resize(std::min(line.find('#'), line.size()));
  constexpr const char* blanks = " \t\r\n";
  const size_t first = line.find_first_not_of(blanks);
  return first == line.npos ? "" : line.substr(first, line.find_last_not_of(blanks) - first + 1);
}

} // namespace

std::vector<std::string> readHosts(const std::vector<std::string>& entries) {
  constexpr size_t most = 65536; // of workers
  std::vector<std::string> hosts;
  for (const std::string& entry : entries) {
    if (!entry.starts_with('@')) {
      hosts.push_back(entry);
      continue;
    }
    std::ifstream file(entry.substr(1));
    if (!file) throw ClusterError("the list of workers " + entry.substr(1) + " cannot be read");
    const size_t before = hosts.size();
    for (std::string line; hosts.size() < most && std::getline(file, line);)
      if (std::string host = trimmed(std::move(line)); !host.empty()) hosts.push_back(std::move(host));
    if (hosts.size() == before) throw ClusterError("the list of workers " + entry.substr(1) + " names nobody");
  }
  return hosts;
}

} // namespace openrt::cluster
