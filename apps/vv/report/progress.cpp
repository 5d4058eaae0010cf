#include "progress.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "libpicture/files/atomic_file.h"
#include "printable.h"
#include "process/messages.h"

namespace vv {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

const Clock::time_point programStart = Clock::now();

void writeError(const std::string& text) {
  (void)!::write(STDERR_FILENO, text.data(), text.size());
}

constexpr size_t barWidth = 30;

std::string bar(float fraction, bool colour) {
  const size_t done = std::min(size_t(fraction * barWidth), barWidth);
  return fmt::format("{}{}{}{} ", colour ? "\x1b[32m" : "", std::string(done, '#'),
                     colour ? "\x1b[0m" : "", std::string(barWidth - done, '.'));
}

// Returns how many characters fit into a line of the terminal.
size_t lineWidth() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1u : 79u;
}

} // namespace

std::string duration(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const long whole = long(seconds);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

Progress::Progress(const std::string& what, bool quiet)
    : what_(printable(what)), quiet_(quiet), start_(Clock::now()) {
  const char* noColour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  terminal_ = ::isatty(STDERR_FILENO) && terminal && std::string_view(terminal) != "dumb";
  colour_ = terminal_ && !(noColour && *noColour);
  // A picture that is finished at once needs no bar.
  next_ = start_ + (terminal_ ? 300ms : 5s);
}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (shown_ && terminal_) writeError("\r\x1b[K");
  shown_ = false;
}

bool Progress::due() const { return !quiet_ && Clock::now() >= next_; }

void Progress::print(const std::string& bar, const std::string& text) {
  if (terminal_) {
    // A longer line would wrap, and each update would leave a line behind.
    const std::string name = what_.empty() ? "" : what_ + " ";
    const size_t width = lineWidth();
    const bool fits = name.size() + barWidth + 1 + text.size() <= width;
    writeError(fits ? fmt::format("\r{}{}{}\x1b[K", name, bar, text)
                    : fmt::format("\r{}\x1b[K", (name + text).substr(0, width)));
    next_ = Clock::now() + 100ms;
  } else {
    say(fmt::format("vv: {}{}", what_.empty() ? "" : what_ + ": ", text));
    next_ = Clock::now() + 5s;
  }
  shown_ = true;
}

void Progress::show(float fraction, const std::string& more) {
  if (!due()) return;
  fraction = std::clamp(fraction, 0.0f, 1.0f);
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  std::string text = fmt::format("{:3.0f} %  {}", 100 * fraction, duration(elapsed));
  if (fraction > 0.01f)
    text += fmt::format(", about {} to go", duration(elapsed / fraction * (1 - fraction)));
  if (!more.empty()) text += ", " + more;
  print(bar(fraction, colour_), text);
}

void Progress::showStage(const std::string& stage) {
  if (!due()) return;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  print("", fmt::format("{}  {}", stage, duration(elapsed)));
}

StageProgress::StageProgress(const std::string& what, const std::string& stage, bool quiet) {
  if (quiet) return;
  thread_ = std::thread([this, what, stage] {
    try {
      Progress progress(what, false);
      std::unique_lock lock(mutex_);
      while (!ending_.wait_for(lock, 100ms, [this] { return ended_; })) progress.showStage(stage);
    } catch (const std::exception&) {} // no memory: the work goes on without a display
  });
}

StageProgress::~StageProgress() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ending_.notify_all();
  if (thread_.joinable()) thread_.join();
}

double secondsSinceStart() {
  return std::chrono::duration<double>(Clock::now() - programStart).count();
}

} // namespace vv
