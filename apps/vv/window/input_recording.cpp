#include "window/input_recording.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "options/values.h"
#include "process/messages.h"

namespace vv {

InputRecording::InputRecording(std::string path, std::function<void(const std::string&)> onFailure)
    : path_(std::move(path)), onFailure_(std::move(onFailure)) {
  if (path_.empty()) return;
  file_.open(path_, std::ios::binary | std::ios::trunc);
  if (!file_) throw Failure{exitRender, fmt::format("--record-input: cannot write {}", path_)};
}

void InputRecording::write(const std::string& line) {
  if (!file_) return;
  errno = 0;
  if (!(file_ << line << std::flush)) fail(errno);
}

void InputRecording::close() {
  errno = 0;
  if (file_.is_open() && file_ && (file_.close(), !file_)) fail(errno);
}

std::string InputRecording::end() {
  if (!file_.is_open()) return {};
  close();
  if (!file_) return {};
  const std::string text = fmt::format("--record-input: {} ends here, because a recording is "
                                       "that of one world",
                                       path_);
  sayWarning(text);
  return text;
}

void InputRecording::fail(int reason) {
  const std::string text = fmt::format("--record-input: cannot write {}: {}", path_,
                                       std::strerror(reason ? reason : EIO));
  sayError(text);
  onFailure_(text);
}

} // namespace vv
