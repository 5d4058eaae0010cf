#include "run/headless.h"

#include <fmt/format.h>

#include "libpicture/files/atomic_file.h"
#include "options/shader_text.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/describe.h"
#include "report/engine_list.h"
#include "report/exit_code.h"
#include "report/node_list.h"
#include "report/problems.h"
#include "report/progress.h"
#include "report/report.h"
#include "report/shader_list.h"
#include "run/inputs.h"
#include "run/leave_memory.h"
#include "run/outputs.h"
#include "run/picture_files.h"
#include "run/pictures.h"
#include "run/timeline.h"
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
  Headless(const Options& options, const std::string& commandLine)
      : options_(options), commandLine_(commandLine) {
    options_.view.shader = readCameraShader(options_);
  }

  int run() {
    if (options_.has(Job::listShaders)) {
      writeOut(listShaders(options_.render.shaderPath, options_.json));
      return exitDone;
    }
    if (options_.has(Job::listEngines)) {
      writeOut(listEngines(options_.running.scriptPath, options_.json));
      return exitDone;
    }
    if (options_.has(Job::listNodes) && options_.input.empty()) {
      writeOut(listNodes(nullptr, options_.json));
      return exitDone;
    }
    checkOutputs(options_);
    checkInputs(options_);
    std::unique_ptr<xvrml::World> read;
    {
      const StageProgress reading("", "reading the world", options_.quiet);
      read = xvrml::loadWorld(options_.input, options_.load);
    }
    const double before = secondsSinceStart();
    browser_ = startWorld(std::move(read), options_, problems_);
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
    if (!options_.write.empty()) writeText(options_.write, written(world));
    if (options_.check) return check();
    if (options_.job()) inspect(options_.job()->job);
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
  // Returns the text for --write. Relative URLs of a text for standard output stay as they are.
  std::string written(const xvrml::World& world) const {
    return xvrml::writeWorld(world, options_.write == "-" ? "" : options_.write,
                             options_.writeEncoding);
  }

  picture::RenderSettings withoutPicture() const {
    picture::RenderSettings settings = options_.render;
    settings.backend = "null";
    settings.record.clear();
    settings.cluster.reset();
    return settings;
  }

  // Also maps the world, because problems of geometry and textures appear only there; nothing is
  // drawn. With --time or --frames, the world runs up to that time.
  int check() {
    {
      picture::Renderer renderer(*browser_, withoutPicture());
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

  void inspect(Job job) {
    WorldClock(*browser_, options_.fps).advance(options_.time.value_or(0));
    const xvrml::World& world = browser_->world();
    if (job == Job::listNodes) return writeOut(listNodes(&world, options_.json));
    if (job == Job::explain) return explain();
    picture::Renderer renderer(*browser_, withoutPicture());
    if (job == Job::listViewpoints)
      return writeOut(listViewpoints(renderer.viewpoints(), options_.json));
    const picture::Renderer::Place place = renderer.placeOf(options_.view);
    const std::string up = picture::axisName(place.up);
    writeOut(describeWorld(world, renderer.viewpoints(), renderer.bounds(), {up, place.reason},
                           options_.running.scriptPath, options_.json));
  }

  // Renders a picture of a single pixel, because the engine chooses the transport when it renders.
  void explain() {
    picture::RenderSettings settings = options_.render;
    settings.record.clear();
    settings.cluster.reset();
    settings.width = settings.height = settings.samples = 1;
    settings.channels = RT_RGBA;
    settings.error = settings.timeLimit = 0;
    picture::Renderer renderer(*browser_, settings);
    const picture::RenderResult result = renderer.render(options_.view);
    writeOut(explainWorld(options_, browser_->world(), result.stats, renderer.explain()));
  }

  Options options_;
  const std::string& commandLine_;
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
int runWatching(const Options& options, const std::string& commandLine) {
  deferInterrupt(true);
  Watched watched({options.input});
  for (;;) {
    const timespec begin = Watched::now();
    Headless job(options, commandLine);
    runOnce(job);
    watched.add(job.files(), begin);
    watched.add(shaderFiles(options.render.shaderPath), begin);
    if (!options.quiet && !interrupted()) say("vv: waiting for a change of the world's files");
    if (!watched.waitForChange(interrupted)) return exitInterrupted;
  }
}

} // namespace

int runHeadless(const Options& options, const std::string& commandLine) {
  const size_t builtIn = xvrml::nodeTypes().size();
  for (const std::string& refused : xvrml::loadNodePlugins(options.nodePath)) sayWarning(refused);
  if (xvrml::nodeTypes().size() > builtIn) freeAllMemory();
  if (options.watch) return runWatching(options, commandLine);
  auto job = std::make_shared<Headless>(options, commandLine);
  const int code = runOnce(*job);
  if (job->leavesMemory()) leave(std::move(job));
  return code;
}

} // namespace vv
