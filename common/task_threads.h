// task_threads.h: does tasks on threads of its own, so that whoever posts them does not wait. With
// one thread, tasks are done in the order in which they were posted. [functions: any thread]
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <iterator>
#include <mutex>
#include <thread>
#include <vector>

#include "start_threads.h"

class TaskThreads {
 public:
  using Task = std::function<void()>; // must not throw

  explicit TaskThreads(size_t threads = 1) {
    startThreads(threads_, threads, [this](size_t) { run(); });
  }
  // Ends after the present tasks; others that wait are dropped.
  ~TaskThreads() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  TaskThreads(const TaskThreads&) = delete;
  TaskThreads& operator=(const TaskThreads&) = delete;

  void post(Task task) {
    {
      const std::lock_guard lock(mutex_);
      tasks_.push_back(std::move(task));
    }
    changed_.notify_one();
  }
  // Takes all tasks and leaves the vector empty.
  void post(std::vector<Task>& tasks) {
    if (tasks.empty()) return;
    {
      const std::lock_guard lock(mutex_);
      std::move(tasks.begin(), tasks.end(), std::back_inserter(tasks_));
    }
    for (size_t i = 0; i < std::min(tasks.size(), threads_.size()); i++) changed_.notify_one();
    tasks.clear();
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return ending_ || !tasks_.empty(); });
      if (ending_) return;
      const Task task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> tasks_;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};
