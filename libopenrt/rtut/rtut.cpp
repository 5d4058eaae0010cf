// rtut.cpp: Implements the callbacks and the main loop of rtut. Errors are printed on stderr,
// because programs for GLUT have no other place for them.
#include "openrt/rtut.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "rtut/messages.h"
#include "rtut/window.h"

void rtut::complain(std::string_view text) noexcept {
  std::fprintf(stderr, "rtut: %.*s\n", static_cast<int>(text.size()), text.data());
}
void rtut::complain(const char* function, const char* text) noexcept {
  std::fprintf(stderr, "rtut: %s: %s\n", function, text);
}

namespace {

using rtut::complain;
using rtut::guarded;

constexpr int frameMilliseconds = 40; // from one frame in a file to the next
constexpr int bestSamples = 256;      // at most, of a picture that nobody redraws

struct Timer {
  long due;
  void (*call)(int);
  int value;
};

struct Program {
  int x = -1, y = -1, width = 300, height = 300;
  bool single = true, redisplay = true, reshaped = false, leave = false, swapped = false;
  std::optional<int> frames; // in files; else in a window
  int frame = 0;
  bool failed = false; // a picture could not be written, or OPENRT_UT_FRAMES is no number
  std::string pattern = "frame%04d.ppm";
  std::unique_ptr<rtut::Window> window;
  std::vector<Timer> timers;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

  void (*display)() = nullptr;
  void (*reshape)(int, int) = nullptr;
  void (*idle)() = nullptr;
  void (*keyboard)(unsigned char, int, int) = nullptr;
  void (*keyboardUp)(unsigned char, int, int) = nullptr;
  void (*special)(int, int, int) = nullptr;
  void (*specialUp)(int, int, int) = nullptr;
  void (*mouse)(int, int, int, int) = nullptr;
  void (*motion)(int, int) = nullptr;
  void (*passiveMotion)(int, int) = nullptr;
  void (*visibility)(int) = nullptr;
};

Program& program() {
  static Program one;
  return one;
}

void printError(RTenum, const char* message, void*) { complain(message); }
void printMessage(int level, const char* message, void*) {
  if (level >= 2) complain(message);
}

long now(const Program& p) {
  using namespace std::chrono;
  if (p.frames) return long(p.frame) * frameMilliseconds;
  return long(duration_cast<milliseconds>(steady_clock::now() - p.start).count());
}

std::string fileName(const Program& p) {
  char name[4096];
  const size_t at = p.pattern.find('%');
  // The pattern is the user's: only its first %d, with digits between, is a number.
  const size_t end =
      at == std::string::npos ? at : p.pattern.find_first_not_of("0123456789", at + 1);
  if (end == std::string::npos || p.pattern[end] != 'd') return p.pattern;
  const int digits = std::atoi(p.pattern.substr(at + 1, end - at - 1).c_str());
  std::snprintf(name, sizeof(name), "%0*d", std::clamp(digits, 1, 20), p.frame);
  return p.pattern.substr(0, at) + name + p.pattern.substr(end + 1);
}

bool writePicture(const std::string& path, const unsigned char* rgb, int width, int height) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return false;
  std::fprintf(file, "P6\n%d %d\n255\n", width, height);
  const size_t count = size_t(3) * static_cast<size_t>(width) * static_cast<size_t>(height);
  const bool whole = std::fwrite(rgb, 1, count, file) == count;
  return (std::fclose(file) == 0) && whole;
}

// Shows the picture in the window, or writes it.
void present(Program& p) {
  int width = 0, height = 0;
  const unsigned char* rgb = rtglPicture(&width, &height);
  if (!rgb) return;
  if (p.window) p.window->show(rgb, width, height);
  if (p.frames && !writePicture(fileName(p), rgb, width, height)) {
    complain("cannot write " + fileName(p));
    p.failed = true;
    p.leave = true;
  }
}

void reshape(Program& p, int width, int height) {
  p.width = width;
  p.height = height;
  p.reshaped = true;
  p.redisplay = true;
  rtglViewport(0, 0, width, height);
  if (p.reshape) p.reshape(width, height);
}

void display(Program& p) {
  p.redisplay = false;
  p.swapped = false;
  if (p.display) p.display();
  if (p.swapped || !p.single) return;
  rtglFinish(); // programs with one buffer may leave it out
  present(p);
}

void runTimers(Program& p) {
  std::vector<Timer> due;
  const long time = now(p);
  std::erase_if(p.timers, [&](const Timer& timer) {
    if (timer.due > time) return false;
    due.push_back(timer);
    return true;
  });
  for (const Timer& timer : due) timer.call(timer.value);
}

void handle(Program& p, const rtut::Event& e) {
  using rtut::Event;
  switch (e.kind) {
  case Event::close: p.leave = true; break;
  case Event::resize: reshape(p, e.x, e.y); break;
  case Event::expose: present(p); break;
  case Event::key:
    if (auto* call = e.state == RTUT_UP ? p.keyboardUp : p.keyboard)
      call(static_cast<unsigned char>(e.code), e.x, e.y);
    break;
  case Event::special:
    if (auto* call = e.state == RTUT_UP ? p.specialUp : p.special) call(e.code, e.x, e.y);
    break;
  case Event::wheel: // buttons 3 and 4, as freeglut reports it
    for (int state : {RTUT_DOWN, RTUT_UP})
      if (p.mouse) p.mouse(e.code, state, e.x, e.y);
    break;
  case Event::button:
    if (p.mouse) p.mouse(e.code, e.state, e.x, e.y);
    break;
  case Event::motion:
    if (auto* call = e.state ? p.motion : p.passiveMotion) call(e.x, e.y);
    break;
  case Event::none: break;
  }
}

// Returns the milliseconds that the loop may wait for an event: none if there is something to draw.
int patience(const Program& p, bool better) {
  if (p.redisplay || p.idle || better) return 0;
  long wait = 1000;
  for (const Timer& timer : p.timers) wait = std::min(wait, timer.due - now(p));
  return static_cast<int>(std::max(wait, 0L));
}

void runWindow(Program& p) {
  bool better = false; // more samples would make the picture better
  while (!p.leave) {
    for (rtut::Event e = p.window->next(patience(p, better));
         e.kind != rtut::Event::none && !p.leave; e = p.window->next(0))
      handle(p, e);
    runTimers(p);
    if (p.idle) p.idle();
    if (p.leave) break;
    if (p.redisplay) {
      display(p);
      better = true;
    } else if (better && !p.idle) {
      const int samples = rtglRefine();
      better = samples > 0 && samples < bestSamples;
      present(p);
    }
  }
}

void runFrames(Program& p) {
  for (; p.frame < *p.frames && !p.leave; p.frame++) {
    runTimers(p);
    display(p);
    if (p.idle) p.idle();
  }
}

// Does what OPENRT_UT_FRAMES asks for. A value that is no number renders nothing: a script that
// waits for pictures must not get a window.
void useFrames(Program& p, std::string_view text) {
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1) {
    complain("OPENRT_UT_FRAMES=" + std::string(text) + ": a number of frames from 1 is expected");
    count = 0;
    p.failed = true;
  }
  rtutFrames(count, std::getenv("OPENRT_UT_FILE"));
}

} // namespace

void rtutInit(int* argc, char** argv) {
  guarded("rtutInit", [&] {
    Program& p = program();
    if (!rtGetCurrent()) rtInit(argc, argv);
    if (!rtGetCurrent())
      return complain(rtGetError() != RT_NO_ERROR ? rtGetErrorMessage() : "no context");
    rtErrorCallback(printError, nullptr);
    rtLogCallback(printMessage, nullptr);
    rtglErrorCallback(printError, nullptr);
    rtglSamples(1);
    if (const char* frames = std::getenv("OPENRT_UT_FRAMES"); frames && *frames)
      useFrames(p, frames);
    p.start = std::chrono::steady_clock::now();
  });
}

void rtutInitDisplayMode(unsigned int mode) { program().single = !(mode & RTUT_DOUBLE); }
void rtutInitWindowSize(int width, int height) {
  program().width = width;
  program().height = height;
}
void rtutInitWindowPosition(int x, int y) {
  program().x = x;
  program().y = y;
}

int rtutCreateWindow(const char* title) {
  return guarded("rtutCreateWindow", [title] {
    Program& p = program();
    if (p.window) throw std::runtime_error("there is one window, and no second one is made");
    if (!p.frames) {
      try {
        p.window = std::make_unique<rtut::Window>(title ? title : "", p.x, p.y, p.width, p.height);
        p.window->size(p.width, p.height);
      } catch (const std::runtime_error& error) {
        throw std::runtime_error(std::string("there is no window: ") + error.what() +
                                 ". OPENRT_UT_FRAMES=1 renders a picture into a file.");
      }
    }
    rtglSingleBuffer(p.single);
    rtglViewport(0, 0, p.width, p.height);
  });
}
void rtutDestroyWindow(int) { program().leave = true; }
void rtutSetWindowTitle(const char* title) {
  guarded("rtutSetWindowTitle", [title] {
    if (program().window) program().window->setTitle(title ? title : "");
  });
}
void rtutReshapeWindow(int width, int height) {
  guarded("rtutReshapeWindow", [width, height] {
    Program& p = program();
    if (p.window)
      p.window->resize(width, height);
    else
      reshape(p, width, height);
  });
}
void rtutFullScreen(void) {
  guarded("rtutFullScreen", [] {
    if (program().window) program().window->fullScreen();
  });
}

void rtutDisplayFunc(void (*call)(void)) { program().display = call; }
void rtutReshapeFunc(void (*call)(int, int)) { program().reshape = call; }
void rtutIdleFunc(void (*call)(void)) { program().idle = call; }
void rtutKeyboardFunc(void (*call)(unsigned char, int, int)) { program().keyboard = call; }
void rtutKeyboardUpFunc(void (*call)(unsigned char, int, int)) { program().keyboardUp = call; }
void rtutSpecialFunc(void (*call)(int, int, int)) { program().special = call; }
void rtutSpecialUpFunc(void (*call)(int, int, int)) { program().specialUp = call; }
void rtutIgnoreKeyRepeat(int ignore) {
  guarded("rtutIgnoreKeyRepeat", [ignore] {
    if (program().window) program().window->ignoreRepeats(ignore != 0);
  });
}
void rtutMouseFunc(void (*call)(int, int, int, int)) { program().mouse = call; }
void rtutMotionFunc(void (*call)(int, int)) { program().motion = call; }
void rtutPassiveMotionFunc(void (*call)(int, int)) { program().passiveMotion = call; }
void rtutVisibilityFunc(void (*call)(int)) { program().visibility = call; }
void rtutTimerFunc(unsigned int milliseconds, void (*timer)(int), int value) {
  guarded("rtutTimerFunc", [=] {
    Program& p = program();
    if (timer) p.timers.push_back({now(p) + long(milliseconds), timer, value});
  });
}

void rtutPostRedisplay(void) { program().redisplay = true; }
void rtutSwapBuffers(void) {
  guarded("rtutSwapBuffers", [] {
    Program& p = program();
    p.swapped = true;
    rtglEndFrame();
    present(p);
  });
}

int rtutMainLoop(void) {
  Program& p = program();
  if (!p.window && !p.frames) {
    complain("there is no window");
    return 1;
  }
  const bool isWhole = guarded("rtutMainLoop", [&p] {
    if (!p.reshaped) reshape(p, p.width, p.height);
    if (p.visibility) p.visibility(RTUT_VISIBLE);
    p.window ? runWindow(p) : runFrames(p);
  });
  p.leave = false;
  p.window.reset();
  return p.failed || !isWhole ? 2 : 0;
}
void rtutLeaveMainLoop(void) { program().leave = true; }

void rtutFrames(int count, const char* pattern) {
  guarded("rtutFrames", [=] {
    Program& p = program();
    p.frames = std::max(count, 0);
    rtglSamples(4); // nothing refines these pictures
    p.frame = 0;
    if (pattern) p.pattern = pattern;
  });
}

int rtutGet(GLenum what) {
  const Program& p = program();
  switch (what) {
  case RTUT_ELAPSED_TIME: return static_cast<int>(now(p));
  case RTUT_WINDOW_WIDTH: return p.width;
  case RTUT_WINDOW_HEIGHT: return p.height;
  default: return 0;
  }
}
int rtutGetModifiers(void) { return program().window ? program().window->modifiers() : 0; }
