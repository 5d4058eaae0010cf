// values.h: strict readers of option values. Each throws UsageError saying what was expected. [any
// thread]
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/camera.h"

namespace vv {

// Exit codes of the program (docs: vv --help).
enum ExitCode {
  exitDone = 0,
  exitRender = 1,    // the picture could not be made or written
  exitUsage = 2,     // the command line
  exitInput = 3,     // the world is missing or unusable
  exitProblems = 4,  // --check or --strict found problems
  exitMissing = 5,   // a plug-in or a texture is missing under --strict
  exitNoWorkers = 6, // fewer than --require-workers asks for
  exitTryAgain = 75, // out of memory or of another resource
  exitInterrupted = 130
};

struct UsageError : std::runtime_error {
  using runtime_error::runtime_error;
};

// Ends the program with this code once its text is said.
struct Failure {
  int code;
  std::string text;
};

// Pictures number first, first + step ... up to last of a sequence.
struct FrameRange {
  long long first = 0, last = 0, step = 1;
};

long long readInteger(std::string_view text, long long minimum, long long maximum);
double readNumber(std::string_view text, double minimum, double maximum); // both exclusive
double readSeconds(std::string_view text);                                // from 0 to a million
double readShare(std::string_view text); // above 0 up to 1, or a percentage
// A byte or item count, also with the suffixes k, M, G (powers of 1024).
uint64_t readCount(std::string_view text);
bool readSwitch(std::string_view text); // on, off
void readSize(std::string_view text, int& width, int& height);
picture::LookAt readCamera(std::string_view text);
xvrml::Axis readAxis(std::string_view text);  // x, y, z, perhaps with a sign
FrameRange readFrames(std::string_view text); // A-B, A-B/STEP or A
std::vector<std::string_view> split(std::string_view text, char separator);

} // namespace vv
