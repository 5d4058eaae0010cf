#include "session/overlay.h"

#include <fmt/format.h>

#include "libpicture/transport.h"
#include "report/cluster_report.h"
#include "report/describe.h"
#include "session/input/editor_keys.h"

namespace vv {

namespace {

std::string count(uint64_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

double megaraysPerSecond(const RTstats& s) {
  const double rays = double(s.rays.camera + s.rays.shadow + s.rays.secondary);
  return s.time.render > 0 ? rays / s.time.render * 1e-6 : 0;
}

// Says how the picture was made: "preview   29 fps", "12 of 256 samples".
std::string sampling(const SessionFacts& f) {
  using Showing = SessionFacts::Showing;
  if (f.stats.rays.camera == 0) return "first picture ...";
  const std::string what = f.showing == Showing::preview   ? "preview"
                           : f.showing == Showing::samples ? "raw samples"
                                                           : "";
  if (f.frameRate > 0)
    return fmt::format("{}{}{:.{}f} fps", what, what.empty() ? "" : "   ", f.frameRate,
                       f.frameRate < 9.95 ? 1 : 0);
  if (!what.empty()) return what;
  if (f.wanted <= 0) return "moving";
  if (f.finished) return fmt::format("{:.0f} samples", f.samples);
  return fmt::format("{:.0f} of {:.0f} samples{}", f.samples, f.wanted,
                     f.showing == Showing::fading ? " over a preview" : "");
}

std::string problems(const SessionFacts& f) {
  std::string text;
  if (f.errors) text += count(f.errors, "error", "errors");
  if (f.warnings) text += (text.empty() ? "" : ", ") + count(f.warnings, "warning", "warnings");
  return text;
}

// Returns a line for each machine, if there are few.
std::vector<std::string> workerLines(const std::vector<RTworker>& workers) {
  constexpr size_t most = 8;
  std::vector<std::string> lines;
  for (const RTworker& w : workers) {
    if (lines.size() == most) {
      lines.push_back(fmt::format("and {} more", workers.size() - most));
      break;
    }
    const bool here = picture::isHere(w);
    std::string line = fmt::format("{}: {}, {} tiles", here ? "this process" : oneLine(w.name),
                                   count(w.threads, "thread", "threads"), w.jobs);
    if (!w.alive)
      line += ", gone";
    else if (!here)
      line += fmt::format(", {:.1f} ms away", w.latency * 1e3);
    lines.push_back(std::move(line));
  }
  return lines;
}

} // namespace

std::string filterText(const std::string& denoisedBy) {
  return "filtered by " + (denoisedBy.empty() ? "vv itself" : denoisedBy);
}

std::vector<std::string> overlayLines(const SessionFacts& f, bool paused, OverlayLevel level) {
  if (level == OverlayLevel::none) return {};
  std::string first = sampling(f);
  if (f.stats.rays.camera > 0) first += fmt::format("   {:.1f} Mray/s", megaraysPerSecond(f.stats));
  if (f.frameRate > 0) first += fmt::format("   {}x{}", f.width, f.height);
  // Only a still picture has an error that means anything.
  if (f.showing == SessionFacts::Showing::still && f.frameRate <= 0 && f.finished &&
      f.stats.error.pixels > 0)
    first += fmt::format("   error {:.2g} %", 100 * f.stats.error.halfWidth);
  if (f.cluster) first += "   " + workersText(f.workers);
  if (paused) first += "   paused";
  if (f.isRestless && !paused) first += "   P pauses: full picture";
  if (f.loading) first += "   loading ...";
  const std::string wrong = problems(f);
  if (level == OverlayLevel::brief) {
    if (!wrong.empty()) first += "   " + wrong;
    return {first};
  }
  std::vector<std::string> lines{first};
  lines.push_back(fmt::format("\t{} of {}, {}",
                              count(f.stats.scene.triangles, "triangle", "triangles"),
                              count(f.stats.scene.objects, "object", "objects"),
                              count(f.stats.scene.instances, "instance", "instances")));
  lines.push_back(fmt::format("\t{}, {}", count(f.stats.scene.lights, "light", "lights"),
                              count(f.map.textures, "texture", "textures")));
  if (f.stats.transport.chosen)
    lines.push_back(fmt::format("\t{}: {}", picture::transportName(f.stats.transport.chosen),
                                f.stats.transport.reason));
  lines.push_back(fmt::format("\t{}, picture of {}x{}", f.navigation, f.width, f.height));
  if (f.showing == SessionFacts::Showing::preview && f.stats.rays.camera > 0)
    lines.push_back("\t" + filterText(f.denoisedBy));
  for (const std::string& line : workerLines(f.workers)) lines.push_back("\t" + line);
  if (!wrong.empty()) lines.push_back(wrong);
  if (!f.lastProblem.empty()) lines.push_back("\t" + oneLine(f.lastProblem));
  return lines;
}

std::vector<std::string> helpLines(bool isEditing) {
  std::vector<std::string> lines;
  const std::string text = isEditing ? listEditorKeys() : listKeys();
  for (std::string_view rest : split(text, '\n'))
    if (!rest.empty()) lines.emplace_back(rest);
  return lines;
}

} // namespace vv
