// main.cpp: Starts the program vv: reads the options and runs the job.
#include "control/unattended.h"
#include "enough_stack.h"
#include "feature_list.h"
#include "options/help.h"
#include "options/options.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/cluster_report.h"
#include "report/describe.h"
#include "report/exit_code.h"
#include "run/checkpoint.h"
#include "run/headless.h"
#include "run/inputs.h"
#include "server/server.h"
#include "session/input/keys.h"
#include "session/read_script.h"
#include "window/window.h"

namespace {

std::string quoted(int argc, char** argv) {
  std::string line;
  for (int i = 0; i < argc; ++i) line += (i ? " " : "") + std::string(argv[i]);
  return line;
}

int run(int argc, char** argv) {
  vv::Options options = vv::readCommandLine(argc, argv);
  const vv::JobInfo* job = options.job();
  if (job && job->job == vv::Job::help) {
    vv::writeOut(vv::helpText(options.helpTopic));
    return vv::exitDone;
  }
  if (job && job->job == vv::Job::version) {
    vv::writeOut("vv " + vv::version() + "\n");
    return vv::exitDone;
  }
  if (job && job->job == vv::Job::listKeys) {
    vv::writeOut(vv::listKeys());
    return vv::exitDone;
  }
  vv::readScript(options);
  if (!options.merge.empty()) return vv::runMerge(options, quoted(argc, argv));
  vv::warnOfFolders(options);
  vv::joinCluster(options);
  if (options.has(vv::Job::serve)) {
    vv::checkInputs(options);
    return vv::runServer(options, {argv + 1, argv + argc});
  }
  if (options.opensWindow()) {
    vv::checkInputs(options);
    if (options.noWindow) return vv::control::runUnattended(options);
    return vv::runWindow(options, {argv + 1, argv + argc});
  }
  if (job && job->job == vv::Job::listFeatures) {
    vv::writeOut(vv::listFeatures(options.running.scriptPath, options.json));
    return vv::exitDone;
  }
  return vv::runHeadless(options, quoted(argc, argv));
}

// Runs the program and returns its exit code; error messages have been printed.
int runAndReport(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (...) { return vv::sayException(nullptr); }
}

} // namespace

int main(int argc, char** argv) {
  vv::installSignals();
  return withEnoughStack([&] { return runAndReport(argc, argv); });
}
