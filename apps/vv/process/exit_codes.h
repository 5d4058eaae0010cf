// exit_codes.h: Lists the exit codes of the program, and the errors that end it. [any thread]
#pragma once

#include <stdexcept>
#include <string>

namespace vv {

// Exit codes of the program (documented in vv --help all).
enum ExitCode {
  exitDone = 0,
  exitRender = 1,     // the picture could not be made or written
  exitUsage = 2,      // the command line is wrong
  exitInput = 3,      // the world or another input file is missing or unusable
  exitProblems = 4,   // problems, or a difference, were found by what looks for them
  exitMissing = 5,    // under --strict: a plug-in or a texture is missing
  exitNoWorkers = 6,  // there are fewer workers than --require-workers asks for
  exitUnfinished = 7, // --time-limit has ended a run with --resume
  exitTryAgain = 75,  // memory or another resource is exhausted
  exitInterrupted = 130
};

struct UsageError : std::runtime_error {
  using runtime_error::runtime_error;
};

// Ends the program with this exit code after its text has been printed.
struct Failure {
  int code;
  std::string text;
};

} // namespace vv
