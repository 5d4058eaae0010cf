// threads.h: how many threads this process should use: what the machine has, less what affinity,
// control groups and the batch system leave of it. [any]
#pragma once

#include <cstdint>
#include <string_view>

namespace openrt {

uint32_t availableThreads(); // at least 1

// The parts of it that read texts, for tests. CPUs' worth of time; 0: no limit, or nothing that can
// be read.
double groupQuota2(std::string_view cpuMax); // cpu.max of version 2: "QUOTA PERIOD", "max PERIOD"
double groupQuota1(std::string_view quota,
                   std::string_view period); // cpu.cfs_quota_us and cpu.cfs_period_us of version 1
std::string_view groupPath1(
    std::string_view procSelfCgroup); // path of the controller cpu in /proc/self/cgroup, or ""
std::string_view groupPath2(std::string_view procSelfCgroup); // of the unified one
uint32_t slurmThreads(const char* cpusPerTask);               // $SLURM_CPUS_PER_TASK; 0: none
uint32_t fewest(uint32_t allowed, double quota,
                uint32_t batch); // the smallest of those that limit, at least 1

} // namespace openrt
