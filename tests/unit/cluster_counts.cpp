// cluster_counts.cpp: Tests the text of a worker's metrics, line by line: Prometheus is strict.
#include "backend/cluster/worker/counts.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

using namespace openrt;
using namespace openrt::cluster;

TEST(WorkerCounts, areTextForPrometheus) {
  WorkerCounts counts;
  counts.jobs = 12345678901;
  counts.seconds = 0.5;
  counts.inFolder.add(100);
  counts.inFolder.add(23);
  message::Hello self;
  self.library = "1.2.3";
  self.kernel = "a \"quoted\\kernel\nof two lines";
  const std::string text = metricsText(counts, {.threads = 4, .serving = true}, self);
  for (const char* line :
       {"openrt_worker_jobs_total 12345678901\n", "openrt_worker_job_seconds_total 0.5\n",
        "openrt_worker_arrays_total{from=\"folder\"} 2\n",
        "openrt_worker_array_bytes_total{from=\"folder\"} 123\n", "openrt_worker_threads 4\n",
        "openrt_worker_serving 1\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;

  const std::regex comment("# (HELP|TYPE) (openrt_worker_[a-z_]+) .+"),
      sample("(openrt_worker_[a-z_]+)(\\{([a-z]+=\"([^\"\\\\]|\\\\.)*\",?)+\\})? [0-9.e+-]+");
  std::set<std::string> typed, samples;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch parts;
    if (std::regex_match(line, parts, comment)) {
      EXPECT_TRUE(parts[1] == "HELP" || typed.insert(parts[2]).second) << line;
      continue;
    }
    ASSERT_TRUE(std::regex_match(line, parts, sample)) << line;
    EXPECT_TRUE(typed.contains(parts[1])) << line;
    EXPECT_TRUE(samples.insert(line.substr(0, line.rfind(' '))).second) << line;
  }
  EXPECT_GT(samples.size(), 20u);
}
