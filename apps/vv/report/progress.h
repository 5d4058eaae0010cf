// progress.h: Shows the progress of a picture: a bar on a terminal, otherwise a line every few
// seconds. [main thread]
#pragma once

#include <chrono>
#include <string>

namespace vv {

class Progress {
 public:
  // what: text in front of the bar, such as the viewpoint. quiet: nothing is printed.
  Progress(const std::string& what, bool quiet);
  ~Progress();
  // more: text behind the bar, such as the number of workers.
  void show(float fraction, const std::string& more = "");
  void rename(std::string what) { what_ = std::move(what); }
  void clear(); // call it before anything else is printed

 private:
  std::string what_;
  bool quiet_, terminal_, colour_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point start_, next_;
};

// Formats a duration: 83.4 -> "1:23", 7.25 -> "7.2 s".
std::string duration(double seconds);

} // namespace vv
