// input_recording.h: Writes the user's input to the file of --record-input. Owned by the window.
// [main thread]
#pragma once

#include <fstream>
#include <functional>
#include <string>

namespace vv {

class InputRecording {
 public:
  // path: "" records nothing. onFailure: is called with a message if the file cannot be written
  // any more. Throws Failure.
  InputRecording(std::string path, std::function<void(const std::string&)> onFailure);

  bool isOn() const { return file_.is_open(); }
  // Tells whether not everything could be written.
  bool hasFailed() const { return !file_; }
  // Records a line of input. After a failed write nothing more is written, because a script with a
  // gap would replay wrongly.
  void write(const std::string& line);
  void close();
  // Ends the recording, because the time of another world begins at 0. Returns what is said of it.
  std::string end();

 private:
  void fail(int reason);

  const std::string path_;
  const std::function<void(const std::string&)> onFailure_;
  std::ofstream file_;
};

} // namespace vv
