// openrt_threads.cpp: how many threads a process should use: limits of control groups and batch
// systems; the smallest wins.
#include <gtest/gtest.h>

#include "render/frame/threads.h"

namespace {
using namespace openrt;

TEST(Threads, GroupsOfVersion2SayQuotaAndPeriod) {
  EXPECT_EQ(groupQuota2("150000 100000\n"), 1.5);
  EXPECT_EQ(groupQuota2("max 100000\n"), 0);
  for (const char* nothing :
       {"", "\n", "150000", "150000 0", "-1 100000", "0 100000", "a b", "1e5 100000"})
    EXPECT_EQ(groupQuota2(nothing), 0) << nothing;
}

TEST(Threads, GroupsOfVersion1SayItInTwoFiles) {
  EXPECT_EQ(groupQuota1("400000\n", "100000\n"), 4);
  EXPECT_EQ(groupQuota1("-1\n", "100000\n"), 0);
  EXPECT_EQ(groupQuota1("400000", ""), 0);
}

TEST(Threads, ThePathOfTheGroup) {
  const char* one = "12:memory:/a\n4:cpuset,cpuacct:/b\n3:cpu,cpuacct:/slurm/uid_0/"
                    "job_7\n1:name=systemd:/c\n0::/d\n";
  EXPECT_EQ(groupPath1(one), "/slurm/uid_0/job_7");
  EXPECT_EQ(groupPath2(one), "/d");
  EXPECT_EQ(groupPath2("0::/user.slice/a:b\n"), "/user.slice/a:b");
  EXPECT_EQ(groupPath1("0::/user.slice\n"), "");
  for (const char* nothing : {"", "\n\n", "3", "3:cpu", ":::"})
    EXPECT_EQ(groupPath1(nothing), "") << nothing;
}

TEST(Threads, SlurmSaysHowManyATaskHas) {
  EXPECT_EQ(slurmThreads("12"), 12u);
  for (const char* nothing : {"", "0", "-3", "many", "4x"})
    EXPECT_EQ(slurmThreads(nothing), 0u) << nothing;
  EXPECT_EQ(slurmThreads(nullptr), 0u);
}

TEST(Threads, TheSmallestLimitWins) {
  EXPECT_EQ(fewest(8, 0, 0), 8u);
  EXPECT_EQ(fewest(8, 2.5, 0), 3u);
  EXPECT_EQ(fewest(8, 2.5, 2), 2u);
  EXPECT_EQ(fewest(8, 16, 64), 8u);
  EXPECT_EQ(fewest(0, 0.1, 0), 1u);
}

} // namespace
