// video.cpp: see video.h.
#include "video.h"

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "picture/atomic_file.h"
#include "values.h"

extern char** environ;

namespace vv {

namespace {

// What a signal handler must know. `pid` is set last and cleared first.
struct Running {
  std::atomic<int> pid{0};
  char temporary[PATH_MAX];
};
constexpr size_t mostAtOnce = 16;
Running running[mostAtOnce];
std::atomic<uint64_t> taken{0}; // slots, by bit

size_t takeSlot() {
  for (size_t i = 0; i < mostAtOnce; ++i)
    if (!(taken.fetch_or(uint64_t(1) << i) >> i & 1)) return i;
  throw Failure{exitRender, fmt::format("at most {} videos can be made at once", mostAtOnce)};
}

// The arguments behind the input's, per kind of file. Odd sizes get a black row or column where chroma is halved.
std::vector<std::string> encoding(Video kind) {
  const std::string even = "pad=ceil(iw/2)*2:ceil(ih/2)*2";
  switch (kind) {
  case Video::mp4:
    return {"-vf", even, "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"};
  case Video::webm: return {"-vf", even, "-c:v", "libvpx-vp9", "-pix_fmt", "yuv420p", "-crf", "24", "-b:v", "0", "-f", "webm"};
  case Video::gif: return {"-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-loop", "0", "-f", "gif"};
  case Video::none: break;
  }
  return {};
}

std::vector<std::string> commandFor(Video kind, int width, int height, double fps, const std::string& file) {
  std::vector<std::string> command = {"ffmpeg",      "-hide_banner",
                                      "-loglevel",   "error",
                                      "-nostdin",    "-y",
                                      "-f",          "rawvideo",
                                      "-pix_fmt",    "rgb24",
                                      "-video_size", fmt::format("{}x{}", width, height),
                                      "-framerate",  fmt::format("{}", fps),
                                      "-i",          "pipe:0"};
  for (std::string& argument : encoding(kind)) command.push_back(std::move(argument));
  command.push_back("file:" + file); // no name looks like an option or a protocol
  return command;
}

// Returns the path of ffmpeg, or nothing. Elements of PATH that are empty or relative mean the current folder, which may be full
// of downloads: these are passed over.
std::string ffmpegProgram() {
  const char* path = std::getenv("PATH");
  for (std::string_view folder : split(path ? path : "/usr/local/bin:/usr/bin:/bin", ':')) {
    if (!folder.starts_with('/')) continue;
    std::string program = std::string(folder) + "/ffmpeg";
    struct stat info;
    if (::stat(program.c_str(), &info) == 0 && S_ISREG(info.st_mode) && ::access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

// Standard input is the pipe, standard output nothing; SIGPIPE and the interrupts are as usual again.
int spawn(const std::vector<std::string>& command, int input, pid_t& pid) {
  std::vector<char*> arguments;
  for (const std::string& one : command) arguments.push_back(const_cast<char*>(one.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  sigset_t usual;
  ::sigemptyset(&usual);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGUSR1}) ::sigaddset(&usual, signal);
  ::posix_spawnattr_setsigdefault(&attributes, &usual);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  const std::string program = ffmpegProgram();
  const int error =
      program.empty() ? ENOENT : ::posix_spawn(&pid, program.c_str(), &actions, &attributes, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  return error;
}

// Beside the file, of the same suffix.
std::string temporaryFor(const std::string& path, size_t slot) {
  const size_t slash = path.rfind('/');
  const std::string folder = slash == path.npos ? "." : path.substr(0, slash);
  return fmt::format("{}/.vv-{}-video{}{}", folder, ::getpid(), slot, path.substr(path.rfind('.')));
}

} // namespace

Video videoOf(const std::string& path) {
  const size_t dot = path.rfind('.');
  const std::string suffix = dot == path.npos ? "" : path.substr(dot + 1);
  if (suffix == "mp4") return Video::mp4;
  if (suffix == "webm") return Video::webm;
  return suffix == "gif" ? Video::gif : Video::none;
}

std::string whyNoVideo() {
  if (!ffmpegProgram().empty()) return "";
  return "a video is made by the program ffmpeg, which is not on PATH; -o 'picture-{frame:4}.png' writes single pictures";
}

VideoFile::VideoFile(const std::string& path, Video kind, int width, int height, double fps) : path_(path), slot_(takeSlot()) {
  temporary_ = temporaryFor(path, slot_);
  Running& entry = running[slot_];
  int ends[2] = {-1, -1};
  pid_t pid = 0;
  int error = temporary_.size() < sizeof entry.temporary ? 0 : ENAMETOOLONG;
  if (!error && ::pipe2(ends, O_CLOEXEC) != 0) error = errno;
  if (!error) {
    std::memcpy(entry.temporary, temporary_.c_str(), temporary_.size() + 1);
    error = spawn(commandFor(kind, width, height, fps, temporary_), ends[0], pid);
  }
  if (ends[0] >= 0) ::close(ends[0]);
  if (error) {
    if (ends[1] >= 0) ::close(ends[1]);
    taken.fetch_and(~(uint64_t(1) << slot_));
    throw Failure{exitRender, fmt::format("cannot write {}: ffmpeg: {}", path, std::strerror(error))};
  }
  pid_ = pid;
  pipe_ = ends[1];
  entry.pid = pid;
}

VideoFile::~VideoFile() {
  if (pid_) {
    ::kill(pid_, SIGKILL);
    closeAndWait();
    ::unlink(temporary_.c_str());
  }
  taken.fetch_and(~(uint64_t(1) << slot_));
}

int VideoFile::closeAndWait() {
  if (pipe_ >= 0) ::close(pipe_);
  pipe_ = -1;
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {}
  running[slot_].pid = 0;
  pid_ = 0;
  return status;
}

void VideoFile::fail(const std::string& why) {
  if (pid_) closeAndWait();
  ::unlink(temporary_.c_str());
  throw Failure{exitRender, fmt::format("cannot write {}: {}", path_, why)};
}

void VideoFile::add(const std::vector<uint8_t>& rgb) {
  try {
    picture::writeDescriptor(pipe_, {reinterpret_cast<const char*>(rgb.data()), rgb.size()}, "ffmpeg");
  } catch (const std::exception&) { fail("ffmpeg ended early"); }
}

void VideoFile::finish() {
  const int status = closeAndWait();
  if (!WIFEXITED(status)) fail(fmt::format("ffmpeg was ended by signal {}", WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) fail(fmt::format("ffmpeg failed with exit code {}", WEXITSTATUS(status)));
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(std::strerror(errno));
}

void abandonVideos() noexcept {
  for (Running& entry : running) {
    if (const int pid = entry.pid.exchange(0)) {
      ::kill(pid, SIGKILL);
      ::unlink(entry.temporary);
    }
  }
}

} // namespace vv
