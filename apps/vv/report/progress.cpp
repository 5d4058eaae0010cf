#include "progress.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/files/atomic_file.h"
#include "messages.h"
#include "printable.h"

namespace vv {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

void writeError(const std::string& text) {
  (void)!::write(STDERR_FILENO, text.data(), text.size());
}

std::string bar(float fraction, bool colour) {
  constexpr int width = 30;
  const int done = std::clamp(int(fraction * width), 0, width);
  return fmt::format("{}{}{}{}", colour ? "\x1b[32m" : "", std::string(size_t(done), '#'),
                     colour ? "\x1b[0m" : "", std::string(size_t(width - done), '.'));
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

void Progress::show(float fraction, const std::string& more) {
  const auto now = Clock::now();
  if (quiet_ || now < next_) return;
  fraction = std::clamp(fraction, 0.0f, 1.0f);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string text = fmt::format("{:3.0f} %  {}", 100 * fraction, duration(elapsed));
  if (fraction > 0.01f)
    text += fmt::format(", about {} to go", duration(elapsed / fraction * (1 - fraction)));
  if (!more.empty()) text += ", " + more;
  if (terminal_) {
    writeError(fmt::format("\r{}{} {}\x1b[K", what_.empty() ? "" : what_ + " ",
                           bar(fraction, colour_), text));
    next_ = now + 100ms;
  } else {
    say(fmt::format("vv: {}{}", what_.empty() ? "" : what_ + ": ", text));
    next_ = now + 5s;
  }
  shown_ = true;
}

} // namespace vv
