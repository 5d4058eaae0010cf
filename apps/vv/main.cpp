// main.cpp: Starts the program vv: reads the options and runs the job.
#include "enough_stack.h"
#include "jobs.h"
#include "process/signals.h"
#include "report/exit_code.h"

namespace {

// Runs the program and returns its exit code; error messages have been printed.
int runAndReport(int argc, char** argv) {
  try {
    return vv::runJob(vv::readCommandLine(argc, argv), {argv, argv + argc});
  } catch (...) { return vv::sayException(nullptr); }
}

} // namespace

int main(int argc, char** argv) {
  vv::installSignals();
  return withEnoughStack([&] { return runAndReport(argc, argv); });
}
