#include "render/frame/threads.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "number_text.h"
#include "system/threads.h"

namespace openrt {
namespace {

std::string_view word(std::string_view& text) {
  constexpr std::string_view blanks = " \t\r\n";
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(blanks)));
  const std::string_view result = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(result.size());
  return result;
}

// Parses a whole number; 0 if there is none or it is not positive.
double number(std::string_view text) {
  const std::string_view digits = word(text);
  int64_t value = 0;
  return isNumber(digits, value) && value > 0 ? double(value) : 0;
}

std::string contents(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Returns the path of the first wanted line of /proc/self/cgroup. Its lines are
// number:controllers:path.
template <class Wanted> std::string_view pathOf(std::string_view text, const Wanted& wanted) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const size_t first = line.find(':'),
                 second = first == line.npos ? first : line.find(':', first + 1);
    if (second != line.npos &&
        wanted(line.substr(0, first), line.substr(first + 1, second - first - 1)))
      return line.substr(second + 1);
  }
  return {};
}

double smaller(double a, double b) { return a == 0 ? b : b == 0 ? a : std::min(a, b); }

// Returns the tightest quota of the group and its ancestors. In a container the root is the group
// itself.
template <class Quota>
double tightest(const std::string& root, std::string path, const Quota& quota) {
  double result = 0;
  for (int levels = 0; levels < 64; levels++) {
    result = smaller(result, quota(root + path));
    const size_t slash = path.rfind('/');
    if (path.empty() || path == "/" || slash == path.npos) break;
    path.resize(slash);
  }
  return smaller(result, quota(root));
}

double quotaOfGroups() {
  const std::string groups = contents("/proc/self/cgroup");
  const double two =
      tightest("/sys/fs/cgroup", std::string(groupPath2(groups)), [](const std::string& folder) {
        return groupQuota2(contents(folder + "/cpu.max"));
      });
  const auto one = [](const std::string& folder) {
    return groupQuota1(contents(folder + "/cpu.cfs_quota_us"),
                       contents(folder + "/cpu.cfs_period_us"));
  };
  const std::string path(groupPath1(groups));
  return smaller(two, smaller(tightest("/sys/fs/cgroup/cpu", path, one),
                              tightest("/sys/fs/cgroup/cpu,cpuacct", path, one)));
}

} // namespace

double groupQuota2(std::string_view cpuMax) {
  const double quota = number(word(cpuMax)), period = number(word(cpuMax));
  return quota > 0 && period > 0 ? quota / period : 0;
}

double groupQuota1(std::string_view quota, std::string_view period) {
  const double q = number(quota), p = number(period); // "-1" means no quota
  return q > 0 && p > 0 ? q / p : 0;
}

std::string_view groupPath1(std::string_view procSelfCgroup) {
  return pathOf(procSelfCgroup, [](std::string_view, std::string_view controllers) {
    while (!controllers.empty()) {
      const std::string_view name = controllers.substr(0, controllers.find(','));
      if (name == "cpu") return true;
      controllers.remove_prefix(std::min(controllers.size(), name.size() + 1));
    }
    return false;
  });
}

std::string_view groupPath2(std::string_view procSelfCgroup) {
  return pathOf(procSelfCgroup, [](std::string_view id, std::string_view controllers) {
    return id == "0" && controllers.empty();
  });
}

uint32_t slurmThreads(const char* cpusPerTask) {
  constexpr double most = 65536;
  return cpusPerTask ? uint32_t(std::min(most, number(cpusPerTask))) : 0;
}

uint32_t fewest(uint32_t allowed, double quota, uint32_t batch) {
  uint32_t count = std::max(allowed, 1u);
  if (quota > 0) count = std::min(count, uint32_t(std::ceil(std::min(quota, 65536.0))));
  if (batch > 0) count = std::min(count, batch);
  return std::max(count, 1u);
}

uint32_t availableThreads() {
  return fewest(os::allowedProcessors(), quotaOfGroups(),
                slurmThreads(std::getenv("SLURM_CPUS_PER_TASK")));
}

} // namespace openrt
