// pictures.cpp: makes the pictures of a run: views, frames, channels and films.
#include "run/pictures.h"

#include <algorithm>
#include <deque>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/files/atomic_file.h"
#include "libpicture/luminaires.h"
#include "libpicture/measure.h"
#include "libpicture/transport.h"
#include "options/names.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/audit.h"
#include "report/cluster_report.h"
#include "report/describe.h"
#include "report/progress.h"
#include "report/report.h"
#include "run/checkpoint.h"
#include "run/leave_memory.h"
#include "run/outputs.h"
#include "run/picture_files.h"
#include "run/picture_remarks.h"
#include "run/scripted_view.h"
#include "run/sensors.h"
#include "run/timeline.h"
#include "run/view_requests.h"
#include "start/look.h"
#include "start/world_clock.h"
#include "steady_clock.h"

namespace vv {

namespace {

// Makes the pictures of a run in their order: renders, checks, writes, reports.
class Pictures {
 public:
  Pictures(const Options& options, const std::string& commandLine, xvrml::Browser& browser,
           Problems& problems, double startSeconds)
      : options_(options), view_(options.view), commandLine_(commandLine), browser_(browser),
        problems_(problems), startSeconds_(startSeconds),
        checkpoint_(options.keepsSums() ? std::make_unique<Checkpoint>(options) : nullptr),
        files_(options, browser.world(), checkpoint_.get()), remarks_(options, browser) {}

  // Ends the renderer without freeing the shapes.
  void leave();
  int make();

 private:
  size_t total() const;

  // Closes the renderer, because a recording is complete only then.
  void endRecording();

  // Returns the time that the world's clock advances to.
  double instantOf(const Moment& moment) const;
  void tick(double time);

  // Makes the renderer, which maps the shapes of the world.
  void makeRenderer(const picture::RenderSettings& settings);
  bool watch(float fraction);

  // Writes the file of --resume. A failure does not stop the picture.
  void saveSums();
  // Writes it with the sums of a seed that has ended. Returns false, with a message, if it cannot
  // be written; the pictures can be written all the same.
  bool saveEnded(const picture::Sums& sums, const std::vector<std::string>& names);

  // Ends the process when a render does not stop after an interrupt: a shader hangs and blocks the
  // render thread. Saves the finished part of the picture first. If even that hangs, an alarm ends
  // the process (deferInterrupt).
  [[noreturn]] void giveUp(picture::Picture& soFar);

  // Prints messages about workers; the progress bar is cleared for them.
  void reportClusterMessages();

  // Makes the pictures of a moment. first: it is the first one that is shown.
  int makeMoment(const Moment& moment, bool first);

  // Starts a picture. Keeps as many frames in flight as there are machines to work on them, and
  // saves them in order.
  int makeOne(const PictureRequest& request, const Moment& moment);

  // Makes a picture whose sums are kept: seed by seed, from where the file of --resume ends.
  int makeKept(const PictureRequest& request, const Moment& moment);

  // Ends a run whose picture is not finished.
  int endUnfinished();

  // Waits for the oldest frame and saves it.
  int finishOldest();

  // Tells whether there is an oldest frame, which files get.
  bool showsOldest() const { return !inFlight_.empty() && inFlight_.front().moment.isShown; }

  // Tells whether --measure is not all that is asked for.
  bool makesPicture() const { return !options_.outputs.empty() || !options_.compare.empty(); }

  // Writes the readings of the sensors.
  int measure();
  int auditOne(const PictureRequest& request);
  int stopped(const char* text);

  // Returns the end of the scale of false colours (PictureFiles::write). A script may switch them,
  // but not within a sequence, whose pictures have one size.
  std::optional<double> falseColour() const;

  // Saves the picture so far. A failure to write this copy does not stop the picture.
  void savePart(const PictureRequest& request, picture::Picture soFar);
  void finish(const PictureRequest& request, const Moment& moment, picture::RenderResult& result);

  RunningWorld running() const { return {browser_.world(), browser_.scripts()}; }
  void finishSequence();

  const Options& options_;
  picture::View view_; // the options' own, once it is settled whether a camera is left out
  const std::string& commandLine_;
  xvrml::Browser& browser_;
  Problems& problems_;
  const double startSeconds_; // how long the world took to start
  std::unique_ptr<picture::Renderer> renderer_;
  std::unique_ptr<Progress> progress_;
  std::unique_ptr<ScriptedView> scripted_; // null: no --input
  struct FrameInFlight {
    PictureRequest request;
    Moment moment;
  };
  std::deque<FrameInFlight> inFlight_;        // frames being rendered, oldest first
  size_t moments_ = 1, views_ = 1, done_ = 0; // moments; pictures per moment; finished pictures
  bool saveWanted_ = false;
  std::unique_ptr<Checkpoint> checkpoint_; // null: the picture's sums are not kept
  std::vector<std::string> names_;         // names of channel id, before the picture is finished
  bool saveFailed_ = false;                // a write of the file of --resume has failed
  bool anyWorker_ = false;                 // a worker has been connected
  PictureFiles files_;
  PictureRemarks remarks_;
  SequenceStats frames_;
};

void Pictures::leave() {
  if (renderer_) renderer_->leave();
}

int Pictures::make() {
  picture::RenderSettings settings = options_.render;
  if (checkpoint_) {
    settings.keepSums = true;
    // Sums with the same channels, whether there are statistics or not, can be added.
    settings.channels |= RT_VARIANCE | RT_SAMPLES;
    if (checkpoint_->writes()) settings.timeLimit = 0; // it ends the run, not the picture
  }
  // With RT_VARIANCE, RTstats contains the error; spp_mean needs the samples.
  if (!options_.stats.empty() && !options_.isSequence())
    settings.channels |= RT_VARIANCE | RT_SAMPLES;
  settings.denoiser = options_.denoise ? picture::Denoiser::oidn : picture::Denoiser::own;
  if (options_.denoise) settings.channels |= picture::denoiserGuides;
  if (options_.mostDoubt) settings.channels |= RT_ERROR | RT_TRUST;
  if (settings.error > 0) settings.channels |= RT_SAMPLES; // warnOfError() needs the samples
  warnOfAlpha(options_);
  settings.progressive = !options_.isSequence() && picture::isWorthProgressive(settings);
  const Timeline timeline(options_);
  if (options_.script) {
    makeRenderer(settings);
    scripted_ = std::make_unique<ScriptedView>(options_, browser_, *renderer_, view_);
  }
  WorldClock clock([this](double time) { tick(time); }, options_.fps);
  if (!clock.advance(instantOf(timeline.withHistory(0).front())))
    return stopped("vv: interrupted before the first picture");
  if (!renderer_) makeRenderer(settings);
  moments_ = timeline.size();
  if (options_.measures())
    if (const int code = measure(); code != exitDone || !makesPicture()) return code;
  for (size_t i = 0; i < timeline.size(); ++i)
    for (const Moment& moment : timeline.withHistory(i)) {
      if (!clock.advance(instantOf(moment)))
        return inFlight_.empty() ? stopped("vv: interrupted; the pictures so far are saved")
                                 : finishOldest();
      if (const int code = makeMoment(moment, i == 0); code != exitDone) return code;
    }
  while (!inFlight_.empty())
    if (const int code = finishOldest(); code != exitDone) return code;
  finishSequence();
  endRecording();
  if (options_.cluster.used() && !anyWorker_ && !options_.audit && !options_.quiet)
    sayWarning(total() == 1 ? "no worker answered; this machine made the picture alone"
                            : "no worker answered; this machine made the pictures alone");
  return remarks_.hasDoubt() ? exitProblems : exitDone;
}

int Pictures::makeMoment(const Moment& moment, bool first) {
  std::vector<PictureRequest> requests =
      scripted_ ? std::vector<PictureRequest>{{scripted_->view(), {}}}
                : chooseRequests(options_, view_, renderer_->viewpoints(), first);
  views_ = requests.size();
  for (PictureRequest& request : requests) {
    request.turns = !options_.turnsFirstSide() || &request == &requests.front();
    request.isStill = first || !options_.turnsIntoFilm();
    if (request.turns && !options_.turnsIntoFilm() && moment.isShown)
      request.name.frame = moment.frame;
    request.view.turn = moment.turn;
    if (const int code = makeOne(request, moment); code != exitDone) return code;
  }
  return exitDone;
}

size_t Pictures::total() const {
  return options_.turnsFirstSide() ? options_.from.size() + moments_ - 1 : moments_ * views_;
}

void Pictures::endRecording() {
  if (!options_.render.record.empty() && renderer_) renderer_->close();
}

double Pictures::instantOf(const Moment& moment) const {
  return scripted_ ? scripted_->instantOf(moment.time) : moment.time;
}

void Pictures::tick(double time) {
  if (scripted_)
    scripted_->step(time);
  else
    browser_.tick(time);
}

void Pictures::makeRenderer(const picture::RenderSettings& settings) {
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

bool Pictures::watch(float fraction) {
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
  if (showsOldest() && saveWanted_ && renderer_->snapshot(soFar)) {
    saveWanted_ = false;
    savePart(inFlight_.front().request, soFar);
  }
  if (secondsInterrupted() >= stuckSeconds(options_.render)) giveUp(soFar);
  return interrupted() || (checkpoint_ && checkpoint_->timeIsUp());
}

void Pictures::saveSums() {
  try {
    checkpoint_->save(renderer_->sums(), names_);
  } catch (const std::runtime_error& error) {
    if (progress_) progress_->clear();
    if (!std::exchange(saveFailed_, true)) sayWarning(error.what());
  }
}

bool Pictures::saveEnded(const picture::Sums& sums, const std::vector<std::string>& names) {
  try {
    checkpoint_->save(sums, names);
    return true;
  } catch (const std::runtime_error& error) {
    sayError(error.what());
    return false;
  }
}

void Pictures::giveUp(picture::Picture& soFar) {
  progress_.reset();
  const bool saved = showsOldest() && renderer_->snapshot(soFar);
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

void Pictures::reportClusterMessages() {
  if (!options_.render.cluster) return;
  const std::vector<std::string> lines = clusterMessageLines(
      options_.render.cluster->takeMessages(), options_.verbose, options_.quiet);
  if (progress_ && !lines.empty()) progress_->clear();
  for (const std::string& line : lines) say(line);
}

int Pictures::makeOne(const PictureRequest& request, const Moment& moment) {
  if (options_.audit) return auditOne(request);
  if (checkpoint_) return makeKept(request, moment);
  if (!progress_) progress_ = std::make_unique<Progress>(request.name.text(), options_.quiet);
  renderer_->start(request.view, moment.frame);
  inFlight_.push_back({request, moment});
  const size_t most = options_.strict ? 1 : renderer_->maxFramesInFlight();
  while (inFlight_.size() >= most)
    if (const int code = finishOldest(); code != exitDone) return code;
  return exitDone;
}

int Pictures::makeKept(const PictureRequest& request, const Moment& moment) {
  const SeedRange& seeds = options_.seeds;
  for (uint32_t seed = checkpoint_->firstSeed(); seed <= seeds.last; ++seed) {
    const std::string what = seeds.count() > 1 ? fmt::format("seed {}", seed) : request.name.text();
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
    if (seeds.count() > 1) checkpoint_->useAll(result);
    finish(request, moment, result);
    if (!saved) return exitRender;
  }
  return exitDone;
}

int Pictures::endUnfinished() {
  if (interrupted() || !checkpoint_->writes())
    return stopped(checkpoint_->writes() ? "vv: interrupted; the same command continues the picture"
                                         : "vv: interrupted; the picture so far is saved");
  stopped("vv: the time limit is reached; the same command continues the picture");
  return exitUnfinished;
}

int Pictures::finishOldest() {
  if (progress_) progress_->rename(inFlight_.front().request.name.text());
  picture::RenderResult result = renderer_->finish();
  interruptHandled();
  const FrameInFlight flight = std::move(inFlight_.front());
  inFlight_.pop_front();
  const bool isShown = flight.moment.isShown;
  if (isShown) ++done_;
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
  if (isShown) finish(flight.request, flight.moment, result);
  if (!interrupted()) return exitDone;
  return stopped(isShown     ? "vv: interrupted; the picture so far is saved"
                 : done_ > 0 ? "vv: interrupted; the pictures so far are saved"
                             : "vv: interrupted before the first picture");
}

int Pictures::measure() {
  progress_ = std::make_unique<Progress>("sensors", options_.quiet);
  const std::vector<PictureRequest> requests =
      chooseRequests(options_, view_, renderer_->viewpoints());
  std::vector<picture::Measurement> sensors;
  std::vector<picture::Luminaire> luminaires;
  try {
    sensors = renderer_->measure(requests[0].view);
    if (options_.measure.ends_with(".html")) luminaires = renderer_->luminaires();
  } catch (const picture::SensorError& wrong) {
    progress_.reset();
    throw Failure{exitProblems, wrong.what()};
  }
  progress_.reset();
  problems_.tell(browser_.world());
  writeReadings(options_, commandLine_, sensors, std::move(luminaires));
  return interrupted() ? stopped("vv: interrupted; the readings so far are saved") : exitDone;
}

int Pictures::auditOne(const PictureRequest& request) {
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
    writeOutput(output, pathFor(output.path, request.name), output.format->encode(audit.picture()));
  return audit.good() ? exitDone : exitProblems;
}

int Pictures::stopped(const char* text) {
  progress_.reset();
  finishSequence();
  endRecording();
  say(text);
  return exitInterrupted;
}

std::optional<double> Pictures::falseColour() const {
  return scripted_ && !options_.isSequence() ? scripted_->falseColour() : options_.falseColour;
}

void Pictures::savePart(const PictureRequest& request, picture::Picture soFar) {
  try {
    files_.writePart(request, falseColour(), std::move(soFar));
    if (!options_.quiet) say("vv: the picture so far is saved");
  } catch (const std::exception& error) { sayWarning(error.what()); }
}

void Pictures::finish(const PictureRequest& request, const Moment& moment,
                      picture::RenderResult& result) {
  const double start = steadySeconds() + result.denoiseSeconds; // previews were denoised before
  files_.prepare(request, total(), result);
  remarks_.sayLook(result, falseColour().has_value());
  files_.write(request, falseColour(), result);
  const double writeSeconds = steadySeconds() - start - result.denoiseSeconds;
  if (!options_.compare.empty() && !result.interrupted)
    writeOut(compareText(result.picture, options_.compare));
  const bool last = done_ == total();
  remarks_.sayTimes(request, result, writeSeconds, last);
  remarks_.sayHint(request, result, last, inFlight_.empty(), *renderer_);
  remarks_.warnOfError(request, result);
  remarks_.sayDoubt(request, result);
  if (options_.stats.empty()) return;
  if (options_.isSequence())
    frames_.add(request.name, moment.time, result, writeSeconds);
  else
    writeText(options_.stats == "-" ? "-" : pathFor(options_.stats, request.name),
              statsJson(options_, commandLine_, running(), result,
                        {startSeconds_, writeSeconds, secondsSinceStart()}));
}

void Pictures::finishSequence() {
  files_.finishFilms();
  if (!options_.stats.empty() && options_.isSequence())
    writeText(options_.stats,
              frames_.json(options_, commandLine_, running(), startSeconds_, secondsSinceStart()));
}

} // namespace

int makePictures(const Options& options, const std::string& commandLine, xvrml::Browser& browser,
                 Problems& problems, double startSeconds) {
  Pictures pictures(options, commandLine, browser, problems, startSeconds);
  const int code = pictures.make();
  if (leavesMemory(options, browser)) pictures.leave();
  return code;
}

int stuckSeconds(const picture::RenderSettings& render) {
  constexpr int64_t pixelsOfSecond = 500000, most = 120;
  return 4 + int(std::min(int64_t(render.width) * render.height / pixelsOfSecond, most));
}

} // namespace vv
