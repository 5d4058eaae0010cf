// progress.h: Shows the progress of a picture: a bar on a terminal, otherwise a line every few
// seconds. Other stages show their name and the seconds. [main thread]
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace vv {

class Progress {
 public:
  // what: text in front of the bar, such as the viewpoint. quiet: nothing is printed.
  Progress(const std::string& what, bool quiet);
  ~Progress();
  // more: text behind the bar, such as the number of workers.
  void show(float fraction, const std::string& more = "");
  // Shows a stage of unknown length, such as "mapping", and the seconds since the beginning.
  void showStage(const std::string& stage);
  void rename(std::string what) { what_ = std::move(what); }
  void clear(); // call it before anything else is printed

 private:
  bool due() const;
  void print(const std::string& bar, const std::string& text);

  std::string what_;
  bool quiet_, terminal_, colour_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point start_, next_;
};

// Shows a stage during which the main thread is busy, such as reading a world. A thread of its own
// prints the time; the destructor ends it. Nothing else may be printed meanwhile.
class StageProgress {
 public:
  StageProgress(const std::string& what, const std::string& stage, bool quiet);
  ~StageProgress();
  StageProgress(const StageProgress&) = delete;
  StageProgress& operator=(const StageProgress&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable ending_;
  bool ended_ = false;
  std::thread thread_; // not started if `quiet`
};

// Returns the seconds since the program was started.
double secondsSinceStart();

// Formats a duration: 83.4 -> "1:23", 7.25 -> "7.2 s".
std::string duration(double seconds);

} // namespace vv
