// progress.h: how far a picture is: a bar on a terminal, elsewhere a line every few seconds. [main
// thread]
#pragma once

#include <chrono>
#include <string>

namespace vv {

class Progress {
 public:
  // what: shown in front, e.g. the viewpoint; quiet: nothing at all.
  Progress(const std::string& what, bool quiet);
  ~Progress();
  // more: shown behind, e.g. who works on it.
  void show(float fraction, const std::string& more = "");
  void rename(std::string what) { what_ = std::move(what); }
  void clear(); // before something else is said

 private:
  std::string what_;
  bool quiet_, terminal_, colour_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point start_, next_;
};

// 83.4 -> "1:23", 7.25 -> "7.2 s"
std::string duration(double seconds);

} // namespace vv
