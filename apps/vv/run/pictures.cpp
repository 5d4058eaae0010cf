// pictures.cpp: makes the pictures of a run: views, frames, channels and films.
// Longer than 500 lines because one order of steps (render, check, write, report) serves all.
#include "run/pictures.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/denoiser.h"
#include "libpicture/false_colour.h"
#include "libpicture/files/atomic_file.h"
#include "libpicture/files/formats.h"
#include "libpicture/measure.h"
#include "libpicture/transport.h"
#include "nearest.h"
#include "options/names.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/audit.h"
#include "report/cluster_report.h"
#include "report/describe.h"
#include "report/hints.h"
#include "report/measure_report.h"
#include "report/progress.h"
#include "report/report.h"
#include "run/checkpoint.h"
#include "run/leave_memory.h"
#include "run/outputs.h"
#include "run/timeline.h"
#include "session/replay.h"
#include "start/look.h"
#include "start/world_clock.h"

namespace vv {

namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A picture to render: its camera, and the name that identifies it.
struct PictureRequest {
  picture::View view;
  PictureName name;
  bool turns = true;   // the picture is part of the run's films
  bool isStill = true; // the picture is written to files of one picture
};

// Returns the views of one moment. The turntable goes round from the first side of --from.
std::vector<PictureRequest> chooseRequests(const Options& options, const picture::View& view,
                                           const std::vector<xvrml::ViewpointInfo>& viewpoints,
                                           bool first = true) {
  if (options.from.size() > 1) {
    std::vector<PictureRequest> requests;
    for (const picture::Side side : options.from) {
      requests.push_back({view, {picture::sideName(side), {}}});
      requests.back().view.side = side;
      requests.back().view.turns = options.turntable > 0 && requests.size() == 1;
      if (options.turntable > 0 && !first) break;
    }
    return requests;
  }
  if (options.viewpoint.empty() || (options.allViewpoints() && viewpoints.empty()))
    return {{view, {}}};
  std::vector<PictureRequest> requests;
  if (options.allViewpoints()) {
    std::set<std::string> taken;
    for (size_t i = 0; i < viewpoints.size(); ++i) {
      const xvrml::ViewpointInfo& v = viewpoints[i];
      std::string name = fileNamePart(v.name.empty() ? v.description : v.name);
      if (name.empty() || name.size() > 100 || taken.count(name))
        name = std::to_string(i) + (name.empty() || name.size() > 100 ? "" : "-" + name);
      taken.insert(name);
      requests.push_back({view, {name, {}}});
      requests.back().view.viewpoint = i;
    }
    return requests;
  }
  const int index = picture::findViewpoint(viewpoints, options.viewpoint);
  if (index < 0) {
    std::string known;
    std::vector<std::string> names;
    for (size_t i = 0; i < viewpoints.size(); ++i) {
      const xvrml::ViewpointInfo& v = viewpoints[i];
      names.push_back(v.name);
      names.push_back(v.description);
      const std::string& shown = v.name.empty() ? v.description : v.name;
      if (i < 20)
        known += fmt::format("{}{}{}", i ? ", " : "", i, shown.empty() ? "" : " " + oneLine(shown));
    }
    const std::string near = nearest::word(options.viewpoint, names);
    throw Failure{
        exitUsage,
        fmt::format("--viewpoint: the world has no \"{}\"{}; {}", options.viewpoint,
                    near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                    viewpoints.empty() ? "it has no viewpoints" : "its viewpoints are " + known)};
  }
  requests.push_back({view, {}});
  requests.back().view.viewpoint = size_t(index);
  return requests;
}

// Writes a file of -o or --raw. Errors name the option.
void writeOutput(const Output& output, const std::string& path, const std::string& bytes) {
  try {
    picture::writeFile(path, bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", output.option(), error.what()));
  }
}

// Says the files of which options get a picture.
enum class Which : uint8_t { all, shown, raw };
bool isOf(const Output& output, Which only) {
  return only == Which::all || output.raw == (only == Which::raw);
}

class Pictures {
 public:
  Pictures(const Options& options, const std::string& commandLine, xvrml::Browser& browser,
           Problems& problems, double startSeconds)
      : options_(options), view_(options.view), commandLine_(commandLine), browser_(browser),
        problems_(problems), startSeconds_(startSeconds) {}

  // Ends the renderer without freeing the shapes.
  void leave() {
    if (renderer_) renderer_->leave();
  }

  int make() {
    picture::RenderSettings settings = options_.render;
    if (options_.keepsSums()) {
      checkpoint_ = std::make_unique<Checkpoint>(options_);
      settings.keepSums = true;
      // Sums with the same channels, whether there are statistics or not, can be added.
      settings.channels |= RT_VARIANCE | RT_SAMPLES;
      if (checkpoint_->writes()) settings.timeLimit = 0; // it ends the run, not the picture
    }
    // With RT_VARIANCE, RTstats contains the error; spp_mean needs the samples.
    if (!options_.stats.empty() && !options_.isSequence())
      settings.channels |= RT_VARIANCE | RT_SAMPLES;
    if (options_.denoise) settings.channels |= picture::denoiserGuides;
    if (settings.error > 0) settings.channels |= RT_SAMPLES; // whyMissed() needs the samples
    warnOfAlpha();
    settings.progressive = !options_.isSequence() && picture::isWorthProgressive(settings);
    const Timeline timeline(options_);
    if (options_.script) beginScript(settings);
    WorldClock clock([this](double time) { tick(time); }, options_.fps);
    if (!clock.advance(instantOf(timeline[0])))
      return stopped("vv: interrupted before the first picture");
    if (!renderer_) makeRenderer(settings);
    picture::Renderer& renderer = *renderer_;
    moments_ = timeline.size();
    if (options_.measures())
      if (const int code = measure(); code != exitDone || !makesPicture()) return code;
    for (size_t i = 0; i < timeline.size(); ++i) {
      const Moment moment = timeline[i];
      if (!clock.advance(instantOf(moment)))
        return inFlight_.empty() ? stopped("vv: interrupted; the pictures so far are saved")
                                 : finishOldest();
      std::vector<PictureRequest> requests =
          pilot_ ? std::vector<PictureRequest>{scriptedRequest()}
                 : chooseRequests(options_, view_, renderer.viewpoints(), i == 0);
      views_ = requests.size();
      for (PictureRequest& request : requests) {
        request.turns = !options_.turnsFirstSide() || &request == &requests.front();
        request.isStill = i == 0 || !options_.turnsIntoFilm();
        if (request.turns && !options_.turnsIntoFilm()) request.name.frame = moment.frame;
        request.view.turn = moment.turn;
        if (const int code = makeOne(request, moment); code != exitDone) return code;
      }
    }
    while (!inFlight_.empty())
      if (const int code = finishOldest(); code != exitDone) return code;
    finishSequence();
    endRecording();
    if (options_.cluster.used() && !anyWorker_ && !options_.audit && !options_.quiet)
      sayWarning(total() == 1 ? "no worker answered; this machine made the picture alone"
                              : "no worker answered; this machine made the pictures alone");
    return exitDone;
  }

 private:
  size_t total() const {
    return options_.turnsFirstSide() ? options_.from.size() + moments_ - 1 : moments_ * views_;
  }

  // Warns if no output file keeps the requested transparency.
  void warnOfAlpha() const {
    if (options_.quiet || options_.render.background.kind != picture::Background::Kind::none ||
        options_.outputs.empty())
      return;
    const bool kept =
        std::any_of(options_.outputs.begin(), options_.outputs.end(), [](const Output& output) {
          return output.film == picture::FilmKind::none && output.format->keepsAlpha;
        });
    if (!kept)
      sayWarning(
          fmt::format("--background none: only {} files can be transparent; the background is "
                      "black in the other files",
                      picture::formatsWith(&picture::Format::keepsAlpha)));
  }

  // Closes the renderer, because a recording is complete only then.
  void endRecording() {
    if (!options_.render.record.empty() && renderer_) renderer_->close();
  }

  // Sets up the camera of a run with --input. Only the renderer knows the extent of the world,
  // which a view of the whole world needs.
  void beginScript(const picture::RenderSettings& settings) {
    makeRenderer(settings);
    pilot_ = std::make_unique<Pilot>(browser_, 0, options_.view);
    pilot_->setAspect(double(options_.render.width) / options_.render.height);
    if (options_.render.linear && !options_.denoise)
      pilot_->allowFalseColours(options_.falseColour);
    if (pilot_->begin(view_, options_.viewpoint)) present();
    pilot_->animateTransitions();
    replay_ = std::make_unique<Replay>(*pilot_, *options_.script,
                                       [this](const InputEvent&, Action action) {
                                         if (action == Action::frameAll) frameAll();
                                         if (action == Action::beginAgain) present();
                                       });
  }

  void frameAll() { pilot_->frameAll(renderer_->cameraAround(pilot_->camera(), pilot_->aspect())); }

  void present() {
    const std::optional<picture::View> view = pilot_->initialView(view_);
    if (!view) return frameAll();
    const picture::Renderer::Place place = renderer_->placeOf(*view);
    pilot_->present(place.camera, place.up);
  }

  // Returns the time that the world's clock advances to. A script is at the end of a step, as in
  // the window, so that its events have happened.
  double instantOf(const Moment& moment) const {
    return replay_ ? timeOfStep(moment.time, options_.fps) : moment.time;
  }

  void tick(double time) {
    if (replay_)
      replay_->step(time);
    else
      browser_.tick(time);
  }

  PictureRequest scriptedRequest() {
    PictureRequest request;
    request.view.shader = options_.view.shader;
    request.view.intrinsics = options_.view.intrinsics;
    request.view.viewer = pilot_->camera();
    renderer_->change([this](picture::RenderSettings& s) {
      const std::optional<bool> switched = pilot_->headlight();
      s.headlight = options_.render.headlight;
      s.view.exposure = std::clamp(options_.render.view.exposure + pilot_->exposure(),
                                   -picture::mostExposure, picture::mostExposure);
      if (switched)
        s.headlight =
            *switched ? xvrml::MapOptions::Headlight::on : xvrml::MapOptions::Headlight::off;
    });
    return request;
  }

  // Makes the renderer, which maps the shapes of the world.
  void makeRenderer(const picture::RenderSettings& settings) {
    Progress mapping("", options_.quiet);
    renderer_ = std::make_unique<picture::Renderer>(browser_, settings, [&](float) {
      mapping.showStage("mapping");
      return false;
    });
    mapping.clear();
    renderer_->setProgressCallback([this](float fraction) { return watch(fraction); });
    if (view_.authored == picture::View::Authored::unlessCut)
      settleView(renderer_->placeOf(view_).leftOut, renderer_->viewpoints(), options_.quiet, view_);
  }

  bool watch(float fraction) {
    reportClusterMessages();
    const std::string stage = renderer_ ? renderer_->stage() : "";
    if (progress_ && !stage.empty()) {
      progress_->showStage(stage);
    } else if (progress_) {
      const double all = double(total());
      progress_->show(float((double(done_) + double(fraction)) / std::max(1.0, all)),
                      workersText(options_.render.cluster.get()));
    }
    saveWanted_ |= takeSaveRequest();
    if (checkpoint_ && !inFlight_.empty() && checkpoint_->due()) saveSums();
    picture::Picture soFar;
    if (!inFlight_.empty() && saveWanted_ && renderer_->snapshot(soFar)) {
      saveWanted_ = false;
      savePart(inFlight_.front().request, soFar);
    }
    if (secondsInterrupted() >= stuckSeconds(options_.render)) giveUp(soFar);
    return interrupted() || (checkpoint_ && checkpoint_->timeIsUp());
  }

  // Writes the file of --resume. A failure does not stop the picture.
  void saveSums() {
    try {
      checkpoint_->save(renderer_->sums(), names_);
    } catch (const std::runtime_error& error) {
      if (progress_) progress_->clear();
      if (!std::exchange(saveFailed_, true)) sayWarning(error.what());
    }
  }
  // Writes it with the sums of a seed that has ended. Returns false, with a message, if it cannot
  // be written; the pictures can be written all the same.
  bool saveEnded(const picture::Sums& sums, const std::vector<std::string>& names) {
    try {
      checkpoint_->save(sums, names);
      return true;
    } catch (const std::runtime_error& error) {
      sayError(error.what());
      return false;
    }
  }

  // Ends the process when a render does not stop after an interrupt: a shader hangs and blocks the
  // render thread. Saves the finished part of the picture first. If even that hangs, an alarm ends
  // the process (deferInterrupt).
  [[noreturn]] void giveUp(picture::Picture& soFar) {
    progress_.reset();
    const bool saved = !inFlight_.empty() && renderer_->snapshot(soFar);
    if (checkpoint_) saveSums();
    interruptHandled();
    if (saved) savePart(inFlight_.front().request, soFar);
    try {
      finishSequence();
    } catch (const std::exception& error) { sayWarning(error.what()); }
    sayError(fmt::format("a shader did not stop within {} s of the interrupt; {}",
                         secondsInterrupted(),
                         saved ? "the picture so far is saved" : "there is no picture yet"));
    picture::removeTemporaries();
    ::_exit(exitInterrupted);
  }

  // Prints messages about workers; the progress bar is cleared for them.
  void reportClusterMessages() {
    if (!options_.render.cluster) return;
    const std::vector<std::string> lines = clusterMessageLines(
        options_.render.cluster->takeMessages(), options_.verbose, options_.quiet);
    if (progress_ && !lines.empty()) progress_->clear();
    for (const std::string& line : lines) say(line);
  }

  // Starts a picture. Keeps as many frames in flight as there are machines to work on them, and
  // saves them in order.
  int makeOne(const PictureRequest& request, const Moment& moment) {
    if (options_.audit) return auditOne(request);
    if (checkpoint_) return makeKept(request, moment);
    if (!progress_) progress_ = std::make_unique<Progress>(request.name.text(), options_.quiet);
    renderer_->start(request.view);
    inFlight_.push_back({request, moment});
    const size_t most = options_.strict ? 1 : renderer_->maxFramesInFlight();
    while (inFlight_.size() >= most)
      if (const int code = finishOldest(); code != exitDone) return code;
    return exitDone;
  }

  // Makes a picture whose sums are kept: seed by seed, from where the file of --resume ends.
  int makeKept(const PictureRequest& request, const Moment& moment) {
    const SeedRange& seeds = options_.seeds;
    for (uint32_t seed = checkpoint_->firstSeed(); seed <= seeds.last; ++seed) {
      const std::string what =
          seeds.count() > 1 ? fmt::format("seed {}", seed) : request.name.text();
      progress_ = std::make_unique<Progress>(what, options_.quiet);
      renderer_->change([&](picture::RenderSettings& s) { s.quality.set(RT_SEED, double(seed)); });
      if (const picture::Sums sums = checkpoint_->begin(seed)) renderer_->continueFrom(sums);
      inFlight_.push_back({request, moment});
      picture::RenderResult result;
      try {
        renderer_->start(request.view);
        result = renderer_->finish();
      } catch (const picture::RenderError& error) {
        if (error.code != RT_SUMS_ERROR || !checkpoint_->writes()) throw;
        progress_.reset();
        throw Failure{exitUsage,
                      fmt::format("--resume: cannot continue from {}: {}; it is left as it is",
                                  options_.resume, error.what())};
      }
      interruptHandled();
      inFlight_.clear();
      progress_.reset();
      reportClusterMessages();
      problems_.tell(browser_.world());
      if (options_.strict && Problems::any(browser_.world())) {
        sayError("nothing is drawn, because of --strict");
        return result.missing ? exitMissing : exitProblems;
      }
      const picture::Sums sums = renderer_->sums();
      const bool saved = saveEnded(sums, result.picture.names);
      if (result.interrupted) {
        // A picture that had not begun does not replace the one of an earlier run.
        if (sums && seeds.count() == 1) finish(request, moment, result);
        if (saved) return endUnfinished();
        stopped("vv: the picture is not finished");
        return exitRender;
      }
      if (seed < seeds.last) {
        checkpoint_->nextSeed();
        continue;
      }
      ++done_;
      if (seeds.count() > 1) {
        const picture::Sums all = checkpoint_->all();
        result.picture.planes = picture::pictureOf(all, checkpoint_->facts()).planes;
        if (const auto rgba = result.picture.planes.find(RT_RGBA);
            rgba != result.picture.planes.end() &&
            options_.render.background.kind == picture::Background::Kind::file)
          picture::BackgroundLayer(options_.render.background, options_.render.linear)
              .compositeOver(rgba->second, result.picture.width, result.picture.height);
        useStatsOf(all, result.stats);
      }
      finish(request, moment, result);
      if (!saved) return exitRender;
    }
    return exitDone;
  }

  // Replaces the numbers that belong to the picture by those of all its seeds.
  static void useStatsOf(const picture::Sums& all, RTstats& stats) {
    const RTstats sums = picture::statsOf(all);
    stats.cameraRays = sums.cameraRays;
    stats.shadowRays = sums.shadowRays;
    stats.secondaryRays = sums.secondaryRays;
    stats.shaderFaults = sums.shaderFaults;
    stats.errorMean = sums.errorMean;
    stats.errorMeanInterval = sums.errorMeanInterval;
    stats.errorHalfWidth = sums.errorHalfWidth;
    stats.errorP99 = sums.errorP99;
    stats.errorPixels = sums.errorPixels;
    stats.errorTrusted = sums.errorTrusted;
    stats.errorUnmet = sums.errorUnmet;
    stats.cutByDepth = sums.cutByDepth;
    stats.cutByEnergy = sums.cutByEnergy;
    stats.clipped = sums.clipped;
  }

  // Ends a run whose picture is not finished.
  int endUnfinished() {
    if (interrupted() || !checkpoint_->writes())
      return stopped(checkpoint_->writes()
                         ? "vv: interrupted; the same command continues the picture"
                         : "vv: interrupted; the picture so far is saved");
    stopped("vv: the time limit is reached; the same command continues the picture");
    return exitUnfinished;
  }

  // Waits for the oldest frame and saves it.
  int finishOldest() {
    if (progress_) progress_->rename(inFlight_.front().request.name.text());
    picture::RenderResult result = renderer_->finish();
    interruptHandled();
    const FrameInFlight flight = std::move(inFlight_.front());
    inFlight_.pop_front();
    ++done_;
    if (done_ == total()) progress_.reset();
    if (progress_) progress_->clear();
    reportClusterMessages();
    problems_.tell(browser_.world());
    anyWorker_ |= std::any_of(result.workers.begin(), result.workers.end(),
                              [](const RTworker& worker) { return !picture::isHere(worker); });
    if (options_.strict && Problems::any(browser_.world())) {
      sayError(fmt::format("{} is drawn, because of --strict",
                           done_ > 1 ? "no further picture" : "nothing"));
      return result.missing ? exitMissing : exitProblems;
    }
    finish(flight.request, flight.moment, result);
    return interrupted() ? stopped("vv: interrupted; the picture so far is saved") : exitDone;
  }

  // Tells whether --measure is not all that is asked for.
  bool makesPicture() const { return !options_.outputs.empty() || !options_.compare.empty(); }

  // Writes the readings of the sensors.
  int measure() {
    progress_ = std::make_unique<Progress>("sensors", options_.quiet);
    const std::vector<PictureRequest> requests =
        chooseRequests(options_, view_, renderer_->viewpoints());
    std::vector<picture::Measurement> sensors;
    try {
      sensors = renderer_->measure(requests[0].view);
    } catch (const picture::SensorError& wrong) {
      progress_.reset();
      throw Failure{exitProblems, wrong.what()};
    }
    progress_.reset();
    problems_.tell(browser_.world());
    if (sensors.empty() && !interrupted())
      throw Failure{exitProblems, "--measure: the world has no ORTSensor"};
    const bool json = options_.measure.ends_with(".json");
    writeText(options_.measure,
              json ? measurementsJson(sensors, commandLine_) : measurementsCsv(sensors));
    for (const picture::Measurement& sensor : sensors) {
      if (options_.quiet) break;
      say("vv: " + oneLine(measurementText(sensor)));
      for (const std::string& text :
           measurementWarnings(sensor, {options_.render.error, uint32_t(options_.render.samples),
                                        options_.render.timeLimit > 0}))
        sayWarning(oneLine(text));
    }
    return interrupted() ? stopped("vv: interrupted; the readings so far are saved") : exitDone;
  }

  int auditOne(const PictureRequest& request) {
    Audit audit(options_, browser_.world(), *renderer_);
    audit.setProgress([this](const std::string& what) {
      progress_.reset();
      if (!what.empty()) progress_ = std::make_unique<Progress>(what, options_.quiet);
    });
    const bool finished = audit.run(request.view);
    progress_.reset();
    problems_.tell(browser_.world());
    if (!finished) return stopped("vv: interrupted before the audit was finished");
    writeOut(audit.text());
    for (const Output& output : options_.outputs)
      writeOutput(output, pathFor(output.path, request.name),
                  output.format->encode(audit.picture()));
    return audit.good() ? exitDone : exitProblems;
  }

  int stopped(const char* text) {
    progress_.reset();
    finishSequence();
    endRecording();
    say(text);
    return exitInterrupted;
  }

  // Returns the end of the scale of false colours, 0: chosen by the first picture; none: they are
  // not wanted. A script may switch them, but not within a sequence, whose pictures have one size.
  std::optional<double> falseColour() const {
    return pilot_ && !options_.isSequence() ? pilot_->falseColour() : options_.falseColour;
  }

  // Returns the picture in false colours, if they are wanted. All pictures of a run have one scale,
  // so that they can be compared and have one size: the given one, or that of the first picture.
  std::optional<picture::Picture> inFalseColours(const picture::Picture& made, bool complete) {
    const std::optional<double> wanted = falseColour();
    if (!wanted) return {};
    double most = *wanted > 0 ? *wanted : endOfScale_;
    if (!(most > 0)) most = picture::mostLuminance(made);
    if (complete) endOfScale_ = most;
    return picture::falseColours(made, most);
  }

  // coloured: the picture in false colours, for files that are made for screens. complete: it is
  // finished. only: the options whose files are written; every other file is left as it is.
  void writePictures(const PictureRequest& request, const picture::Picture& made,
                     const std::optional<picture::Picture>& coloured, bool complete,
                     Which only = Which::all) {
    const picture::Picture wanted = picture::withChannels(made, options_.render.channels);
    for (const Output& output : options_.outputs) {
      if (output.film != picture::FilmKind::none || !request.isStill || !isOf(output, only))
        continue;
      const bool shows = coloured && output.format->appliesCurve;
      std::string bytes = output.format->encode(shows ? *coloured : wanted);
      if (options_.sums && complete && output.format->encode == picture::encodeExr)
        picture::appendSums(bytes, checkpoint_->behindPixels());
      if (output.path == "-") {
        picture::writeDescriptor(STDOUT_FILENO, bytes, "standard output");
        continue;
      }
      const std::string path = pathFor(output.path, request.name);
      protectFilesOf(browser_.world(), path);
      writeOutput(output, path, bytes);
    }
  }

  // Adds a picture to the film of its view.
  void addToFilms(const PictureRequest& request, const picture::Picture& made,
                  Which only = Which::all) {
    for (const Output& output : options_.outputs) {
      if (output.film == picture::FilmKind::none || !request.turns || !isOf(output, only)) continue;
      const std::string path = pathFor(output.path, {request.name.viewpoint, {}});
      auto& [of, film] = films_[path];
      of = &output;
      try {
        if (!film)
          film = std::make_unique<picture::Film>(output.film, made.width, made.height, options_.fps,
                                                 made.note);
        film->add(picture::displayBytes(made));
      } catch (const std::runtime_error& error) {
        throw Failure{exitRender, fmt::format("cannot make {}: {}", path, error.what())};
      }
    }
  }

  // Saves the picture so far. A failure to write this copy does not stop the picture.
  void savePart(const PictureRequest& request, picture::Picture soFar) {
    try {
      if (options_.fitExposure)
        soFar.view.exposure = exposure_ ? *exposure_ : picture::fittingExposure(soFar);
      writePictures(request, soFar, inFalseColours(soFar, false), false);
      if (!options_.quiet) say("vv: the picture so far is saved");
    } catch (const std::exception& error) { sayWarning(error.what()); }
  }

  // Chooses the exposure of all pictures by the first one, if that is wanted.
  void fitExposure(picture::Picture& made) {
    if (!options_.fitExposure) return;
    if (!exposure_) {
      exposure_ = picture::fittingExposure(made);
      if (!options_.quiet)
        say(fmt::format("vv: --exposure auto is {:g} for {}", *exposure_,
                        total() > 1 ? "all pictures" : "this picture"));
    }
    made.view.exposure = *exposure_;
  }

  // Says once that a picture for screens is white for the most part.
  void sayBrightness(const picture::Picture& made) {
    const bool shown =
        std::any_of(options_.outputs.begin(), options_.outputs.end(), [](const Output& output) {
          return output.film != picture::FilmKind::none || output.format->appliesCurve;
        });
    if (options_.quiet || !shown || falseColour() || brightnessSaid_) return;
    const std::string hint = tooBrightHint(made);
    brightnessSaid_ = !hint.empty();
    if (brightnessSaid_) say("vv: " + hint);
  }

  // Says once that the pictures are biased.
  void sayBias(const picture::Picture& made) {
    if (made.note.empty() || std::exchange(biasSaid_, true) || options_.quiet) return;
    say(fmt::format("vv: {}; without {}, pictures are unbiased", made.note,
                    options_.denoise ? "--denoise" : "--preview"));
  }

  // Writes the files of --raw and denoises the picture for those of -o. A picture that was
  // interrupted stays as it is, in all files.
  void denoise(const PictureRequest& request, picture::RenderResult& result) {
    writePictures(request, result.picture, {}, !result.interrupted, Which::raw);
    if (result.interrupted) return;
    addToFilms(request, result.picture, Which::raw);
    const auto start = Clock::now();
    const StageProgress progress(request.name.text(), "denoising", options_.quiet);
    if (!denoiser_) denoiser_ = std::make_unique<picture::PictureDenoiser>(options_.render.threads);
    result.picture = denoiser_->denoised(result.picture);
    result.denoiseSeconds = secondsSince(start);
  }

  void finish(const PictureRequest& request, const Moment& moment, picture::RenderResult& result) {
    const auto start = Clock::now();
    fitExposure(result.picture);
    if (options_.denoise) denoise(request, result);
    sayBias(result.picture);
    if (!result.interrupted) sayBrightness(result.picture);
    const auto coloured = inFalseColours(result.picture, !result.interrupted);
    writePictures(request, result.picture, coloured, !result.interrupted, Which::shown);
    if (!result.interrupted)
      addToFilms(request, coloured ? *coloured : result.picture, Which::shown);
    const double writeSeconds = secondsSince(start) - result.denoiseSeconds;
    if (!options_.compare.empty() && !result.interrupted)
      writeOut(compareText(result.picture, options_.compare));
    if (options_.verbose)
      say(fmt::format("vv: {}{}{} triangles, mapped in {}, rendered in {}{}, written in {}",
                      request.name.text(), request.name.text().empty() ? "" : ": ",
                      result.stats.triangles, duration(result.mapSeconds),
                      duration(result.renderSeconds),
                      options_.denoise ? ", denoised in " + duration(result.denoiseSeconds) : "",
                      duration(writeSeconds)));
    if (options_.verbose && done_ == total()) reportLast(result);
    // A recording has the pictures of the run alone, without those that look for a hint.
    const bool nothing =
        !options_.quiet && !result.interrupted && options_.render.record.empty() &&
        (showsNothing(result.picture) || showsStudioAlone(result) || mayBeUnlit(options_, result));
    anythingShown_ = anythingShown_ || !nothing;
    // In a sequence, only the last picture prints a hint.
    const bool hints = !options_.isSequence() || (done_ == total() && !anythingShown_);
    if (nothing && hints && inFlight_.empty())
      if (const std::string hint = hintFor(options_, request.view, result, *renderer_);
          !hint.empty())
        say("vv: " + hint);
    const RTstats& s = result.stats;
    if (options_.render.error > 0 && !result.interrupted && s.errorPixels > 0 &&
        s.errorHalfWidth > 1.001 * options_.render.error)
      sayWarning(fmt::format("{}{}--error promised {:.3g} %, reached {:.3g} %: {}",
                             request.name.text(), request.name.text().empty() ? "" : ": ",
                             100 * options_.render.error, 100 * s.errorHalfWidth,
                             whyMissed(result)));
    if (options_.stats.empty()) return;
    if (options_.isSequence())
      frames_.add(request.name, moment.time, result, writeSeconds);
    else
      writeText(options_.stats == "-" ? "-" : pathFor(options_.stats, request.name),
                statsJson(options_, commandLine_, running(), result,
                          {startSeconds_, writeSeconds, secondsSinceStart()}));
  }

  // Tells whether there is nothing in the studio, whose backdrop is seen all the same.
  bool showsStudioAlone(const picture::RenderResult& result) const {
    return options_.render.studio.on &&
           (result.map.shapes == 0 || (inFlight_.empty() && renderer_->bounds().empty));
  }

  RunningWorld running() const { return {browser_.world(), browser_.scripts()}; }

  // Prints the details that -v adds after the last picture.
  void reportLast(const picture::RenderResult& result) {
    for (const std::string& line : clusterLines(result)) say(line);
    if (const xvrml::ScriptCounts counts = browser_.scripts(); counts.started > 0)
      say(fmt::format("vv: {} of {} Scripts run; {} calls took {}", counts.started, counts.scripts,
                      counts.calls, duration(counts.seconds)));
  }

  // Explains why a picture has not reached --error, from the samples that it took.
  std::string whyMissed(const picture::RenderResult& result) const {
    const auto samples = result.picture.planes.find(RT_SAMPLES);
    const auto most = float(options_.render.samples);
    double full = 0, largest = 0; // share of the pixels with all samples; most samples of a pixel
    if (samples != result.picture.planes.end() && !samples->second.empty()) {
      const std::vector<float>& all = samples->second;
      full = double(std::count_if(all.begin(), all.end(), [&](float n) { return n >= most; })) /
             double(all.size());
      largest = double(*std::max_element(all.begin(), all.end()));
    }
    const bool lamps = picture::transportInfo(result.stats.transport).tracesLamps;
    const std::string paths = lamps && options_.render.timeLimit <= 0
                                  ? ". Paths from lamps are limited as well (docs/error-bars.md): "
                                    "--spp N without --error "
                                    "takes N of both per pixel"
                                  : "";
    if (full > 0)
      return fmt::format(
          "{:.3g} % of the pixels took {} samples, the most allowed; --spp allows more{}",
          100 * full, options_.render.samples, paths);
    if (options_.render.timeLimit > 0)
      return "the time limit ended the rendering; --time-limit allows more time";
    const std::string taken =
        fmt::format("its pixels took at most {:.0f} of the {} samples allowed, ", largest, most);
    if (lamps)
      return taken + "and --error alone decides how many paths from lamps are taken; --spp N "
                     "without --error takes N of both per pixel";
    return taken + "which was enough in the pilot samples that decide it, but the picture is "
                   "noisier than these; a smaller --error takes more samples";
  }

  void finishSequence() {
    for (auto& [path, film] : films_) {
      protectFilesOf(browser_.world(), path);
      writeOutput(*film.of, path, film.film->finish());
    }
    films_.clear();
    if (!options_.stats.empty() && options_.isSequence())
      writeText(options_.stats, frames_.json(options_, commandLine_, running(), startSeconds_,
                                             secondsSinceStart()));
  }

  const Options& options_;
  picture::View view_; // the options' own, once it is settled whether a camera is left out
  const std::string& commandLine_;
  xvrml::Browser& browser_;
  Problems& problems_;
  const double startSeconds_; // how long the world took to start
  std::unique_ptr<picture::Renderer> renderer_;
  std::unique_ptr<Progress> progress_;
  std::unique_ptr<Pilot> pilot_; // drives the world with --input; null: no --input
  std::unique_ptr<Replay> replay_;
  struct FrameInFlight {
    PictureRequest request;
    Moment moment;
  };
  std::deque<FrameInFlight> inFlight_;        // frames being rendered, oldest first
  size_t moments_ = 1, views_ = 1, done_ = 0; // moments; pictures per moment; finished pictures
  bool anythingShown_ = false;                // a picture has shown something
  bool saveWanted_ = false;
  std::unique_ptr<Checkpoint> checkpoint_; // null: the picture's sums are not kept
  std::vector<std::string> names_;         // names of channel id, before the picture is finished
  bool saveFailed_ = false;                // a write of the file of --resume has failed
  bool biasSaid_ = false, brightnessSaid_ = false;
  bool anyWorker_ = false; // a worker has been connected
  struct OpenFilm {
    const Output* of = nullptr;
    std::unique_ptr<picture::Film> film;
  };
  std::map<std::string, OpenFilm> films_;              // indexed by path
  std::unique_ptr<picture::PictureDenoiser> denoiser_; // null before the first use
  SequenceStats frames_;
  std::optional<double> exposure_; // what --exposure auto gave; none: no picture has been made
  double endOfScale_ = 0;          // brightest false colour in cd/m2; 0: no picture has been made
};

} // namespace

int makePictures(const Options& options, const std::string& commandLine, xvrml::Browser& browser,
                 Problems& problems, double startSeconds) {
  Pictures pictures(options, commandLine, browser, problems, startSeconds);
  const int code = pictures.make();
  if (leavesMemory(options, browser)) pictures.leave();
  return code;
}

void writeText(const std::string& path, const std::string& text) {
  if (path == "-")
    writeData(text);
  else
    picture::writeFile(path, text);
}

int stuckSeconds(const picture::RenderSettings& render) {
  constexpr int64_t pixelsOfSecond = 500000, most = 120;
  return 4 + int(std::min(int64_t(render.width) * render.height / pixelsOfSecond, most));
}

} // namespace vv
