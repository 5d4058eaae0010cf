// budget.cpp: keeps the budgets in a registry outside of World, because World is a public class
// whose layout must not change.
#include "base/budget.h"

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <unordered_map>

#include <sys/resource.h>
#include <unistd.h>

#include "xvrml/world.h"

namespace xvrml {
namespace {

constexpr uint64_t unlimited = ~uint64_t(0);

// Reads a number from a file that contains nothing else; "max" gives `unlimited`.
uint64_t readNumber(const char* path) {
  std::FILE* file = std::fopen(path, "re");
  if (!file) return unlimited;
  unsigned long long number = 0;
  const bool read = std::fscanf(file, "%llu", &number) == 1;
  std::fclose(file);
  return read ? uint64_t(number) : unlimited;
}

struct Registry {
  std::mutex mutex;
  std::unordered_map<const World*, BudgetPtr> budgets;
};

// Never destroyed: worlds may outlive static objects.
Registry& registry() {
  static Registry& all = *new Registry;
  return all;
}

} // namespace

uint64_t defaultWorldBytes() {
  static const uint64_t bytes = [] {
    uint64_t most = unlimited;
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    if (pages > 0 && page > 0) most = uint64_t(pages) * uint64_t(page);
    most = std::min(most, readNumber("/sys/fs/cgroup/memory.max"));
    most = std::min(most, readNumber("/sys/fs/cgroup/memory/memory.limit_in_bytes"));
    rlimit space{};
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
      most = std::min(most, uint64_t(space.rlim_cur));
    return std::max<uint64_t>(most / 8, 256ull << 20);
  }();
  return bytes;
}

Budget::Budget(uint64_t limit) : limit_(limit > 0 ? limit : defaultWorldBytes()) {}

bool Budget::take(uint64_t bytes) {
  uint64_t used = used_.load(std::memory_order_relaxed);
  do {
    if (bytes > limit_ || used > limit_ - bytes) return false;
  } while (!used_.compare_exchange_weak(used, used + bytes, std::memory_order_relaxed));
  return true;
}

uint64_t Budget::left() const {
  const uint64_t now = used();
  return now < limit_ ? limit_ - now : 0;
}

std::string Budget::name() const { return "limit worldBytes=" + std::to_string(limit_); }

BudgetPtr budgetOf(const World& world) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  BudgetPtr& budget = all.budgets[&world];
  if (!budget) budget = std::make_shared<Budget>(world.options.limits.worldBytes);
  return budget;
}

void setBudget(const World& world, BudgetPtr budget) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  all.budgets[&world] = std::move(budget);
}

void forgetBudget(const World& world) noexcept {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  all.budgets.erase(&world);
}

} // namespace xvrml
