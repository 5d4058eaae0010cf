// threads.h: the number of threads that this process should use: the machine's, limited by CPU
// affinity, control groups and the batch system. [any]
#pragma once

#include <cstdint>
#include <string_view>

namespace openrt {

uint32_t availableThreads(); // at least 1

// Parses cpu.max of cgroups version 2: "QUOTA PERIOD" or "max PERIOD".
double groupQuota2(std::string_view cpuMax);
// Parses cpu.cfs_quota_us and cpu.cfs_period_us of cgroups version 1.
double groupQuota1(std::string_view quota, std::string_view period);
// Returns the path of the cpu controller in /proc/self/cgroup, or "".
std::string_view groupPath1(std::string_view procSelfCgroup);
// Returns the path of the unified hierarchy in /proc/self/cgroup, or "".
std::string_view groupPath2(std::string_view procSelfCgroup);
uint32_t slurmThreads(const char* cpusPerTask); // Parses $SLURM_CPUS_PER_TASK; 0: no limit.
// Returns the smallest of the limits that are set, at least 1.
uint32_t fewest(uint32_t allowed, double quota, uint32_t batch);

} // namespace openrt
