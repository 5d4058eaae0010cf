#include "backend/cluster/master/hosts.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "backend/backend.h"
#include "backend/cluster/net/addresses.h"
#include "file_contents.h"

namespace openrt::cluster {
namespace {

std::string trimmed(std::string line) {
  line.resize(std::min(line.find('#'), line.size()));
  constexpr const char* blanks = " \t\r\n";
  const size_t first = line.find_first_not_of(blanks);
  return first == line.npos ? "" : line.substr(first, line.find_last_not_of(blanks) - first + 1);
}

std::string listOf(const std::string& path) {
  constexpr size_t most = 16 << 20; // bytes
  try {
    return fileContents(path, most);
  } catch (const std::runtime_error& why) {
    throw ClusterError(path + ": the list of workers cannot be read: " + why.what());
  }
}

} // namespace

std::vector<std::string> readHosts(const std::vector<std::string>& entries) {
  constexpr size_t most = 65536; // limit on the workers in a list
  std::vector<std::string> hosts;
  for (const std::string& entry : entries) {
    if (!entry.starts_with('@')) {
      hosts.push_back(entry);
      continue;
    }
    std::istringstream file(listOf(entry.substr(1)));
    const size_t before = hosts.size();
    size_t number = 1; // line number
    for (std::string line; hosts.size() < most && std::getline(file, line); ++number) {
      std::string host = trimmed(std::move(line));
      if (host.empty()) continue;
      try {
        Address::parse(host);
      } catch (const std::runtime_error& error) {
        throw ClusterError(entry.substr(1) + ":" + std::to_string(number) + ": " + error.what());
      }
      hosts.push_back(std::move(host));
    }
    if (hosts.size() == before)
      throw ClusterError(entry.substr(1) + ": the list of workers is empty");
  }
  return hosts;
}

} // namespace openrt::cluster
