#include "run/headless.h"

#include <fmt/format.h>

#include "edit/journal_file.h"
#include "libpicture/files/atomic_file.h"
#include "options/shader_text.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/describe.h"
#include "report/exit_code.h"
#include "report/problems.h"
#include "report/progress.h"
#include "report/shader_list.h"
#include "run/farm_jobs.h"
#include "run/inputs.h"
#include "run/leave_memory.h"
#include "run/outputs.h"
#include "run/picture_files.h"
#include "run/pictures.h"
#include "run/timeline.h"
#include "run/write_world.h"
#include "start/look.h"
#include "start/watched.h"
#include "start/world_clock.h"
#include "start/world_start.h"
#include "xvrml/node_plugin.h"

namespace vv {

namespace {

// Seconds that saving what there is may take when a shader hangs after the first SIGINT or SIGTERM;
// then the process ends. With a small picture, supervisors wait about as long (docker stop: 10).
constexpr int savingSeconds = 5;

class Headless {
 public:
  Headless(const Options& options, const std::vector<std::string>& words,
           const Inspection& inspection)
      : options_(options), words_(words), commandLine_(fmt::format("{}", fmt::join(words, " "))),
        inspection_(inspection) {
    options_.view.shader = readCameraShader(options_);
  }

  int run() {
    if (inspection_.ofProgram && (!inspection_.ofWorld || options_.input.empty())) {
      writeOut(inspection_.ofProgram(options_));
      return exitDone;
    }
    checkOutputs(options_);
    checkInputs(options_);
    if (options_.missing && Timeline(options_).size() == 0) {
      if (!options_.quiet) say("vv: no frame is missing");
      return exitDone;
    }
    std::unique_ptr<xvrml::World> read;
    {
      const StageProgress reading("", "reading the world", options_.quiet);
      read = xvrml::loadWorld(options_.input, options_.load);
    }
    if (const std::string edits = journalBeside(options_.input); !options_.quiet && !edits.empty())
      say(fmt::format("vv: {} has unsaved edits in {}: vv edit offers them", options_.input,
                      edits));
    const double before = secondsSinceStart();
    WorldText text;
    const auto keepText = [&](const xvrml::World& world) { text = textOf(options_, world); };
    const bool writesText = !options_.write.empty() && !options_.writeFormat;
    browser_ =
        startWorld(std::move(read), options_, problems_, writesText ? keepText : BeforeScripts());
    const double startSeconds = secondsSinceStart() - before;
    const xvrml::World& world = browser_->world();
    if (options_.makesPictures()) {
      chooseLook(options_, world, options_.render);
      chooseView(options_, world, options_.view);
    }
    protectFilesOf(world, options_);
    if (options_.strict && Problems::any(world)) {
      if (!options_.check)
        sayError(fmt::format("nothing is {}, because of --strict",
                             options_.makesPictures() ? "drawn" : "done"));
      return exitProblems;
    }
    if (writesText)
      writeWorld(options_, text);
    else if (!options_.write.empty())
      exportWorld(options_, *browser_);
    if (options_.check) return check();
    if (inspection_.ofWorld) inspect();
    if (options_.farmJobs > 0) {
      writeOut(farmJobs(options_, words_, *browser_));
      return exitDone;
    }
    int code = exitDone;
    if (options_.makesPictures()) {
      deferInterrupt(true, unsigned(stuckSeconds(options_.render) + savingSeconds));
      code = makePictures(options_, commandLine_, *browser_, problems_, startSeconds);
    }
    if (code == exitDone) problems_.reportEnd(browser_->world());
    return code;
  }

  const Options& options() const { return options_; }
  // Returns whether the world may be left to the operating system when the process ends.
  bool leavesMemory() const { return browser_ && vv::leavesMemory(options_, *browser_); }

  // Returns the files that the world was made of; empty if it could not be loaded.
  std::vector<std::string> files() const {
    return browser_ ? usedFiles(browser_->world()) : std::vector<std::string>{};
  }

 private:
  // Also maps the world, because problems of geometry and textures appear only there; nothing is
  // drawn. With --time or --frames, the world runs up to that time.
  int check() {
    {
      picture::Renderer renderer(*browser_, withoutPicture(options_.render));
      WorldClock clock(*browser_, options_.fps);
      const Timeline timeline(options_);
      for (size_t i = 0; i < timeline.size() && clock.advance(timeline[i].time); ++i)
        renderer.prepare(options_.view);
    }
    problems_.tell(browser_->world());
    const xvrml::World& world = browser_->world();
    const xvrml::Diagnostics& d = world.diagnostics;
    if (!options_.quiet)
      say(fmt::format("vv: {}: {}, {}", world.path, counted(d.errors(), "error"),
                      counted(d.warnings(), "warning")));
    return Problems::any(world) ? exitProblems : exitDone;
  }

  void inspect() {
    WorldClock(*browser_, options_.fps).advance(options_.time.value_or(0));
    writeOut(inspection_.ofWorld(options_, *browser_));
  }

  Options options_;
  const std::vector<std::string>& words_; // the words of the command line
  const std::string commandLine_;
  const Inspection inspection_;
  Problems problems_{options_};
  std::unique_ptr<xvrml::Browser> browser_;
};

// Runs the job and prints the error that stopped it.
int runOnce(Headless& job) {
  try {
    return job.run();
  } catch (...) { return sayException(&job.options()); }
}

// Repeats the job whenever a file has changed. Errors are printed, and watching continues.
int runWatching(const Options& options, const std::vector<std::string>& words,
                const Inspection& inspection) {
  deferInterrupt(true);
  Watched watched({options.input});
  for (;;) {
    const timespec begin = Watched::now();
    Headless job(options, words, inspection);
    runOnce(job);
    watched.add(job.files(), begin);
    watched.add(shaderFiles(options.render.shaderPath), begin);
    if (!options.quiet && !interrupted()) say("vv: waiting for a change of the world's files");
    if (!watched.waitForChange(interrupted)) return exitInterrupted;
  }
}

} // namespace

int runHeadless(const Options& options, const std::vector<std::string>& words,
                const Inspection& inspection) {
  const size_t builtIn = xvrml::nodeTypes().size();
  for (const std::string& refused : xvrml::loadNodePlugins(options.nodePath)) sayWarning(refused);
  if (xvrml::nodeTypes().size() > builtIn) freeAllMemory();
  if (options.watch) return runWatching(options, words, inspection);
  auto job = std::make_shared<Headless>(options, words, inspection);
  const int code = runOnce(*job);
  if (job->leavesMemory()) leave(std::move(job));
  return code;
}

} // namespace vv
