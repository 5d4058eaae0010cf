// headless.cpp: see headless.h.
#include "headless.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <new>
#include <set>

#include <fmt/format.h>
#include <unistd.h>

#include "describe.h"
#include "messages.h"
#include "picture/atomic_file.h"
#include "picture/nearest.h"
#include "progress.h"
#include "report.h"
#include "signals.h"

namespace vv {

namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr size_t messagesShown = 50;

// A picture ends the program with this code.
struct Failure {
  int code;
  std::string text;
};

std::string readStandardInput(uint64_t limit) {
  std::string bytes;
  char block[65536];
  for (;;) {
    const ssize_t got = ::read(STDIN_FILENO, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Failure{exitInput, "cannot read standard input"};
    if (got == 0) return bytes;
    bytes.append(block, size_t(got));
    if (bytes.size() > limit)
      throw Failure{exitInput, fmt::format("standard input is longer than the limit fileBytes ({})", limit)};
  }
}

std::unique_ptr<xvrml::World> load(const Options& options) {
  if (options.input != "-") return xvrml::loadWorld(options.input, options.load);
  return xvrml::loadWorldFromMemory(readStandardInput(options.load.limits.fileBytes), "-", options.load);
}

// One picture to make: where from, and the name that tells it from the others.
struct Job {
  picture::View view;
  std::string name; // empty: the only one
};

std::string fileNamePart(const std::string& name) {
  std::string part;
  for (unsigned char c : name) part += std::isalnum(c) || c == '-' || c == '_' || c >= 0x80 ? char(c) : '_';
  return part;
}

std::vector<Job> chooseJobs(const Options& options, const std::vector<xvrml::ViewpointInfo>& viewpoints) {
  if (options.viewpoint.empty() || (options.allViewpoints() && viewpoints.empty())) return {{options.view, ""}};
  std::vector<Job> jobs;
  if (options.allViewpoints()) {
    std::set<std::string> taken;
    for (size_t i = 0; i < viewpoints.size(); ++i) {
      const xvrml::ViewpointInfo& v = viewpoints[i];
      std::string name = fileNamePart(v.name.empty() ? v.description : v.name);
      if (name.empty() || name.size() > 100 || taken.count(name))
        name = std::to_string(i) + (name.empty() || name.size() > 100 ? "" : "-" + name);
      taken.insert(name);
      jobs.push_back({options.view, name});
      jobs.back().view.viewpoint = i;
    }
    return jobs;
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
      if (i < 20) known += fmt::format("{}{}{}", i ? ", " : "", i, shown.empty() ? "" : " " + oneLine(shown));
    }
    const std::string near = picture::nearest(options.viewpoint, names);
    throw Failure{exitUsage, fmt::format("--viewpoint: the world has no \"{}\"{}; {}", options.viewpoint,
                                         near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                                         viewpoints.empty() ? "it has no viewpoints" : "its viewpoints are " + known)};
  }
  jobs.push_back({options.view, ""});
  jobs.back().view.viewpoint = size_t(index);
  return jobs;
}

// "{viewpoint}" in the path, or before its suffix.
std::string outputPath(const std::string& path, const Job& job) {
  constexpr std::string_view place = "{viewpoint}";
  const size_t at = path.find(place);
  if (at != path.npos) return path.substr(0, at) + (job.name.empty() ? "0" : job.name) + path.substr(at + place.size());
  if (job.name.empty()) return path;
  const size_t dot = path.rfind('.');
  return path.substr(0, dot) + "-" + job.name + path.substr(dot);
}

class Headless {
 public:
  Headless(const Options& options, const std::string& commandLine) : options_(options), commandLine_(commandLine) {}

  int run() {
    if (options_.listNodes && options_.input.empty()) return writeOut(listNodes(nullptr, options_.json)), exitDone;
    checkOutputs();
    world_ = load(options_);
    tellProblems();
    if (options_.verbose)
      say(fmt::format("vv: {} nodes, parsed in {}, Inlines and prototypes in {}", world_->nodeCount,
                      duration(world_->times.parse), duration(world_->times.load)));
    if (options_.strict && anyProblem()) return exitProblems;
    if (!options_.write.empty()) writeText(options_.write, xvrml::writeWorld(*world_));
    if (options_.check) return check();
    inspect();
    if (options_.makesPictures()) return makePictures();
    return exitDone;
  }

 private:
  bool anyProblem() const { return world_->diagnostics.errors() + world_->diagnostics.warnings() > 0; }

  // Problems that were not told yet.
  void tellProblems() {
    xvrml::Diagnostics fresh;
    const auto& list = world_->diagnostics.list();
    for (; told_ < list.size(); ++told_) fresh.add(list[told_]);
    sayDiagnostics(fresh, options_.verbose || options_.check ? 0 : messagesShown, options_.quiet);
    if (const uint64_t dropped = world_->diagnostics.dropped(); dropped > droppedTold_) {
      say(fmt::format("vv: and {} more problems", dropped - droppedTold_));
      droppedTold_ = dropped;
    }
  }

  // Said before the work, not after it.
  void checkOutputs() const {
    for (const Output& output : options_.outputs) {
      if (output.path == "-" && ::isatty(STDOUT_FILENO)) throw Failure{exitUsage, "-o -: a picture is not written to a terminal"};
      if (output.path == "-" || options_.allViewpoints()) continue;
      const std::string why = picture::whyNotWritable(output.path);
      if (!why.empty()) throw Failure{exitRender, why};
    }
  }

  void writeText(const std::string& path, const std::string& text) {
    if (path == "-")
      writeOut(text);
    else
      picture::writeFile(path, text);
  }

  picture::RenderSettings withoutPicture() const {
    picture::RenderSettings settings = options_.render;
    settings.backend = "null";
    settings.record.clear();
    return settings;
  }

  // Also maps the world, into nothing: what is wrong with its geometry and its textures shows only there.
  int check() {
    {
      picture::Renderer renderer(*world_, withoutPicture());
      renderer.prepare(options_.view);
    }
    tellProblems();
    const xvrml::Diagnostics& d = world_->diagnostics;
    if (!options_.quiet) say(fmt::format("vv: {}: {} errors, {} warnings", world_->path, d.errors(), d.warnings()));
    return anyProblem() ? exitProblems : exitDone;
  }

  void inspect() {
    if (options_.listNodes) writeOut(listNodes(world_.get(), options_.json));
    if (!options_.info && !options_.listViewpoints) return;
    picture::Renderer renderer(*world_, withoutPicture());
    if (options_.listViewpoints)
      writeOut(listViewpoints(renderer.viewpoints(), options_.json));
    else
      writeOut(describeWorld(*world_, renderer.viewpoints(), renderer.bounds(), options_.json));
  }

  int makePictures() {
    deferInterrupt(true);
    picture::RenderSettings settings = options_.render;
    if (!options_.stats.empty()) settings.channels |= RT_VARIANCE | RT_SAMPLES;
    std::unique_ptr<Progress> progress;
    const Job* current = nullptr;
    bool saveWanted = false;
    picture::Renderer renderer(*world_, settings);
    renderer.setWatch([&](float fraction) {
      if (progress) progress->show(fraction);
      saveWanted |= takeSaveRequest();
      picture::Picture soFar;
      if (current && saveWanted && renderer.snapshot(soFar)) {
        saveWanted = false;
        savePart(*current, soFar);
      }
      return interrupted();
    });
    std::vector<Job> jobs = chooseJobs(options_, renderer.viewpoints());
    for (const Job& job : jobs) {
      current = &job;
      progress = std::make_unique<Progress>(job.name, options_.quiet);
      picture::RenderResult result = renderer.render(job.view);
      progress.reset();
      tellProblems();
      if (options_.strict && anyProblem()) return result.missing ? exitMissing : exitProblems;
      finish(job, result);
      if (interrupted()) {
        say("vv: interrupted; the picture so far is saved");
        return exitInterrupted;
      }
    }
    return exitDone;
  }

  // The channels that were asked for, without those that only the statistics need.
  void writePictures(const Job& job, const picture::Picture& made) {
    picture::Picture wanted;
    wanted.width = made.width;
    wanted.height = made.height;
    wanted.linear = made.linear;
    wanted.names = made.names;
    for (const auto& [bit, plane] : made.planes)
      if (options_.render.channels & bit) wanted.planes[bit] = plane;
    for (const Output& output : options_.outputs) {
      const std::string bytes = picture::encode(wanted, output.format);
      if (output.path == "-")
        picture::writeDescriptor(STDOUT_FILENO, bytes, "standard output");
      else
        picture::writeFile(outputPath(output.path, job), bytes);
    }
  }

  // A copy that cannot be written is no reason to give up the picture.
  void savePart(const Job& job, const picture::Picture& soFar) {
    try {
      writePictures(job, soFar);
      if (!options_.quiet) say("vv: the picture so far is saved");
    } catch (const std::exception& error) { sayWarning(error.what()); }
  }

  void finish(const Job& job, const picture::RenderResult& result) {
    const auto start = Clock::now();
    writePictures(job, result.picture);
    const double writeSeconds = secondsSince(start);
    if (options_.verbose)
      say(fmt::format("vv: {} triangles, mapped in {}, rendered in {}, written in {}", result.stats.triangles,
                      duration(result.mapSeconds), duration(result.renderSeconds), duration(writeSeconds)));
    if (!options_.stats.empty())
      writeText(options_.stats == "-" ? "-" : outputPath(options_.stats, job),
                statsJson(options_, commandLine_, *world_, result, {writeSeconds, secondsSince(start_)}));
  }

  const Options& options_;
  const std::string& commandLine_;
  const Clock::time_point start_ = Clock::now();
  std::unique_ptr<xvrml::World> world_;
  size_t told_ = 0;
  uint64_t droppedTold_ = 0;
};

} // namespace

int runHeadless(const Options& options, const std::string& commandLine) {
  try {
    return Headless(options, commandLine).run();
  } catch (const Failure& failure) {
    sayError(failure.text);
    return failure.code;
  } catch (const xvrml::LoadError& error) {
    say(error.diagnostic.text());
    return exitInput;
  } catch (const std::bad_alloc&) {
    sayError("out of memory");
    return exitTryAgain;
  } catch (const std::exception& error) {
    sayError(error.what());
    return exitRender;
  }
}

} // namespace vv
