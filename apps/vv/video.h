// video.h: a sequence of pictures as a video file, made by the program ffmpeg, which gets the pixels through a pipe. It is
// started without a shell, in a process group of its own (Ctrl-C is vv's), and writes beside the file's name; the file gets its
// name when it is complete. [main thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vv {

enum class Video { none, mp4, webm, gif };
Video videoOf(const std::string& path); // by the suffix

// Why there can be no video: ffmpeg is in no folder of PATH that is named from the root. Empty: it is.
std::string whyNoVideo();

class VideoFile {
 public:
  // Throws Failure.
  VideoFile(const std::string& path, Video kind, int width, int height, double fps);
  ~VideoFile(); // unfinished: the file is not made
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;
  void add(const std::vector<uint8_t>& rgb); // red, green, blue; first row at the top
  void finish();

 private:
  [[noreturn]] void fail(const std::string& why);
  int closeAndWait(); // the exit status of ffmpeg
  std::string path_, temporary_;
  size_t slot_;
  int pid_ = 0, pipe_ = -1;
};

// Ends the programs that run and removes their unfinished files. May be called from a signal handler that ends the process.
void abandonVideos() noexcept;

} // namespace vv
