#include "run/outputs.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "edit/journal_file.h"
#include "libpicture/files/atomic_file.h"
#include "libpicture/files/formats.h"
#include "options/names.h"
#include "process/messages.h"
#include "run/timeline.h"
#include "start/watched.h"

namespace vv {

namespace {

namespace fs = std::filesystem;

struct Named {
  std::string option, path;
};

// Returns every output file whose name is known. For a sequence this is the first picture; the
// pictures of --viewpoint all are missing.
std::vector<Named> outputsOf(const Options& options) {
  const std::optional<long long> frame =
      options.isSequence() ? std::optional(Timeline(options)[0].frame.value_or(0)) : std::nullopt;
  std::vector<Named> all;
  std::vector<std::string> views = {""};
  if (options.from.size() > 1) {
    views.clear();
    for (const picture::Side side : options.from) views.emplace_back(picture::sideName(side));
  }
  for (const Output& output : options.outputs)
    for (const std::string& view : views) {
      if (options.allViewpoints()) continue;
      const bool film = output.film != picture::FilmKind::none,
                 numbered = !film && views.size() == 1 && !options.turnsIntoFilm();
      if (!film || view == views[0])
        all.push_back(
            {output.option(), pathFor(output.path, {view, numbered ? frame : std::nullopt})});
    }
  if (!options.allViewpoints() || options.isSequence()) all.push_back({"--stats", options.stats});
  all.push_back({"--resume", options.resume});
  all.push_back({"--write", options.write});
  all.push_back({"--record", options.render.record});
  all.push_back({"--record-input", options.recordInput});
  std::erase_if(all, [](const Named& one) { return one.path.empty() || one.path == "-"; });
  return all;
}

std::vector<Named> inputsOf(const Options& options) {
  std::vector<Named> all;
  for (const std::string& part : options.merge) all.push_back({"a file of vv merge", part});
  for (const std::string& one : options.joined) all.push_back({"a picture of vv film", one});
  for (const std::string& one : options.compared.files)
    all.push_back({"a picture of vv compare", one});
  const std::vector<Named> named = {
      {"the world that is read", options.input},
      {"the picture of --environment", options.render.environment},
      {"the weather file of --sky", picture::fileOfSky(options.skyText)},
      {"the script of --input", options.inputScript},
      {"the matrix of --pose", options.poseFile},
      {"the picture of --compare", options.compare},
      {"the file of --key", options.cluster.key},
      {"the file of --allow-keys", options.cluster.allow}};
  all.insert(all.end(), named.begin(), named.end());
  if (options.cluster.workers.starts_with('@'))
    all.push_back({"the file of --workers", options.cluster.workers.substr(1)});
  for (const picture::ShaderRule& rule : options.shaders) // DEF=CLASS:texture=@FILE
    for (size_t at = rule.text.find("=@"); at != rule.text.npos; at = rule.text.find("=@", at + 1))
      all.push_back(
          {"a file of --shader", rule.text.substr(at + 2, rule.text.find(':', at) - at - 2)});
  std::erase_if(all, [](const Named& one) { return one.path.empty() || one.path == "-"; });
  return all;
}

// Returns one name for each place, whether the file exists or not. Returns "" for devices, which
// may be named several times.
std::string placeOf(const std::string& path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) return "";
  const fs::path place =
      fs::weakly_canonical(fs::absolute(picture::followLinks(path), error), error);
  return error ? "" : place.string();
}

void refuseKept(const Options& options) {
  for (const Named& output : outputsOf(options))
    if (const std::string why = picture::whyNotWritable(output.path); !why.empty())
      throw Failure{exitRender, fmt::format("{}: {}", output.option, why)};
}

// Warns if --channels asks for more than colours and no output file keeps them.
void warnOfLostChannels(const Options& options) {
  if (options.quiet || options.outputs.empty() || !options.merge.empty() ||
      !(options.render.channels & ~uint32_t(RT_RGBA)))
    return;
  for (const Output& output : options.outputs)
    if (output.format && output.format->encode == picture::encodeExr) return;
  sayWarning(fmt::format("--channels: only EXR files keep channels besides rgba, {} does not",
                         options.outputs[0].path));
}

} // namespace

void checkOutputs(const Options& options) {
  warnOfLostChannels(options);
  for (const Output& output : options.outputs) {
    if (output.path == "-" && ::isatty(STDOUT_FILENO))
      throw Failure{exitUsage,
                    fmt::format("{} -: standard output is a terminal; redirect it to a file or a "
                                "pipe",
                                output.option())};
    if (output.film == picture::FilmKind::none) continue;
    if (const std::string why = picture::whyNoFilm(output.film); !why.empty())
      throw Failure{exitRender, output.path + ": " + why};
  }
  std::map<std::string, std::string> taken; // maps a place to its option
  for (const Named& output : outputsOf(options)) {
    const std::string place = placeOf(output.path);
    if (place.empty()) continue;
    const auto [found, fresh] = taken.try_emplace(place, output.option);
    if (!fresh)
      throw Failure{exitUsage, fmt::format("{} and {} name one file, {}: each needs its own",
                                           found->second, output.option, output.path)};
  }
  for (const Named& input : inputsOf(options)) picture::protectFile(input.path, input.option);
  refuseKept(options);
}

void warnOfAlpha(const Options& options) {
  if (options.quiet || options.render.background.kind != picture::Background::Kind::none ||
      options.outputs.empty())
    return;
  const bool kept =
      std::any_of(options.outputs.begin(), options.outputs.end(), [](const Output& output) {
        return output.film == picture::FilmKind::none && output.format->keepsAlpha;
      });
  if (!kept)
    sayWarning(fmt::format("--background none: only {} files can be transparent; the background is "
                           "black in the other files",
                           picture::formatsWith(&picture::Format::keepsAlpha)));
}

void protectFilesOf(const xvrml::World& world, const Options& options) {
  for (const Named& output : outputsOf(options)) protectFilesOf(world, output.path);
  refuseKept(options);
}

// Without an existing file of this name, nothing can be replaced, and the walk over the world is
// skipped.
void protectFilesOf(const xvrml::World& world, const std::string& output) {
  if (isJournalOf(world.path, output))
    throw Failure{exitRender, fmt::format("{} is where the edits of {} are kept until they are "
                                          "saved: another name is needed",
                                          output, world.path)};
  std::error_code error;
  if (!fs::is_regular_file(output, error)) return;
  for (const std::string& file : usedFiles(world))
    picture::protectFile(file, "a file that the world is made of");
}

} // namespace vv
