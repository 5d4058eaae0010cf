#include "jobs.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "control/unattended.h"
#include "feature_list.h"
#include "options/help.h"
#include "process/messages.h"
#include "report/cluster_report.h"
#include "report/describe.h"
#include "report/engine_list.h"
#include "report/node_list.h"
#include "report/shader_list.h"
#include "run/checkpoint.h"
#include "run/compare.h"
#include "run/film_join.h"
#include "run/headless.h"
#include "run/inputs.h"
#include "run/inspect.h"
#include "server/server.h"
#include "session/input/editor_keys.h"
#include "session/read_script.h"
#include "window/window.h"

namespace vv {

namespace {

struct Run {
  Options& options;
  const std::vector<std::string>& words; // words of the command line, the first is the program
  Inspection inspection;

  std::string commandLine() const { return fmt::format("{}", fmt::join(words, " ")); }
  std::vector<std::string> arguments() const { return {words.begin() + 1, words.end()}; }
};

int print(const std::string& text) {
  writeOut(text);
  return exitDone;
}

// Prepares what a world needs, and warns of folders that are missing and of suns that have set.
void prepare(Options& options) {
  readScript(options);
  warnOfFolders(options);
  warnOfSky(options);
  joinCluster(options);
}

int help(const Run& run) { return print(helpText(run.options.helpTopic)); }
int printVersion(const Run&) { return print("vv " + version() + "\n"); }
int printKeys(const Run&) {
  return print(listKeys() + "\nWhile the editor is open:\n" + listEditorKeys());
}
int merge(const Run& run) { return runMerge(run.options, run.commandLine()); }
int compare(const Run& run) { return runCompare(run.options); }

int film(const Run& run) { return joinFilm(run.options); }

int serve(const Run& run) {
  prepare(run.options);
  checkInputs(run.options);
  return runServer(run.options, run.arguments());
}

int printFeatures(const Run& run) {
  prepare(run.options);
  return print(listFeatures(run.options.running.scriptPath, run.options.json));
}

// Loads the world, inspects it, and makes the pictures that are asked for.
int withoutWindow(const Run& run) {
  prepare(run.options);
  return runHeadless(run.options, run.words, run.inspection);
}

int showWorld(const Run& run) {
  prepare(run.options);
  checkInputs(run.options);
  if (run.options.noWindow) return control::runUnattended(run.options);
  return runWindow(run.options, run.arguments());
}

std::string nodeTypes(const Options& options) { return listNodes(nullptr, options.json); }
std::string shaders(const Options& options) {
  return listShaders(options.render.shaderPath, options.json);
}
std::string engines(const Options& options) {
  return listEngines(options.running.scriptPath, options.json);
}

// How a job is done. The rows are in the order of jobTable.
struct JobRow {
  Job job;
  int (*run)(const Run& run);
  Inspection inspection = {};
};
constexpr JobRow rows[] = {
    {Job::help, help},
    {Job::version, printVersion},
    {Job::merge, merge},
    {Job::compare, compare},
    {Job::film, film},
    {Job::serve, serve},
    {Job::edit, showWorld},
    {Job::listKeys, printKeys},
    {Job::info, withoutWindow, {nullptr, inspectWorld}},
    {Job::explain, withoutWindow, {nullptr, inspectObjects}},
    {Job::listNodes, withoutWindow, {nodeTypes, inspectNodes}},
    {Job::listViewpoints, withoutWindow, {nullptr, inspectViewpoints}},
    {Job::listShaders, withoutWindow, {shaders, nullptr}},
    {Job::listEngines, withoutWindow, {engines, nullptr}},
    {Job::listFeatures, printFeatures},
};
static_assert(std::equal(std::begin(rows), std::end(rows), std::begin(jobTable), std::end(jobTable),
                         [](const JobRow& row, const JobInfo& info) {
                           return row.job == info.job;
                         }));

} // namespace

int runJob(Options options, const std::vector<std::string>& words) {
  if (const JobInfo* job = options.job()) {
    const JobRow& row = rows[job - jobTable];
    return row.run({options, words, row.inspection});
  }
  return (options.opensWindow() ? showWorld : withoutWindow)({options, words, {}});
}

} // namespace vv
