// openrt_task_threads.cpp: tasks on threads of their own (common/task_threads.h).
#include <atomic>
#include <future>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "task_threads.h"

namespace {

TEST(TaskThreads, OneThreadDoesTasksInTheirOrder) {
  std::vector<int> done;
  std::promise<void> last;
  TaskThreads threads;
  for (int i = 0; i < 100; i++) threads.post([&done, i] { done.push_back(i); });
  threads.post([&last] { last.set_value(); });
  last.get_future().wait();
  std::vector<int> expected(100);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(done, expected);
}

TEST(TaskThreads, SeveralThreadsDoEachTaskOfAListOnce) {
  std::atomic<int> sum{0}, left{1000};
  std::promise<void> last;
  TaskThreads threads(4);
  std::vector<TaskThreads::Task> tasks;
  for (int i = 0; i < 1000; i++)
    tasks.push_back([&, i] {
      sum += i;
      if (--left == 0) last.set_value();
    });
  threads.post(tasks);
  EXPECT_TRUE(tasks.empty());
  last.get_future().wait();
  EXPECT_EQ(sum, 999 * 1000 / 2);
}

} // namespace
