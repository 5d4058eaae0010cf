// openrt_replay.cpp: the program openrt-replay: renders a recording again and writes one of its
// frames. It reads the file on the main thread; the local backend has its own threads. Exit codes:
// 0 done, 1 render failed or picture not written, 2 usage, 3 recording missing or unusable.
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "backend/backend.h"
#include "backend/record/reader.h"
#include "enough_stack.h"
#include "option_words.h"
#include "output_written.h"
#include "printable.h"
#include "shading/registry.h"
#include "tools/scene_export.h"

namespace {

using namespace openrt;

enum ExitCode { Done = 0, RenderFailed = 1, Usage = 2, InputUnusable = 3 };

struct Options {
  std::string recording, output, exported, shaderPath;
  uint32_t threads = 0;
  std::string isa = "auto";
  uint64_t frame = 0; // counted from 1; 0: the last frame
  bool stats = false;
};

struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<float> rgba; // top row first
};

void log(int level, const char* message, void*) {
  static const char* const names[] = {"debug", "info", "warning", "error"};
  if (level >= 2)
    std::fprintf(stderr, "openrt-replay: %s: %s\n", names[level > 3 ? 3 : level],
                 printable(message).c_str());
}

// Writes a colour PFM: three floats per pixel, little-endian, rows from the bottom up. The file is
// written under a temporary name and renamed.
bool writePfm(const Picture& picture, const std::string& path) {
  const std::string partial = path + ".partial";
  std::FILE* file = std::fopen(partial.c_str(), "wbe");
  if (!file) return false;
  bool good = std::fprintf(file, "PF\n%u %u\n-1.0\n", picture.width, picture.height) > 0;
  std::vector<float> row(size_t(picture.width) * 3);
  for (uint32_t y = picture.height; y-- > 0 && good;) {
    const float* in = picture.rgba.data() + size_t(y) * picture.width * 4;
    for (size_t x = 0; x < picture.width; x++)
      for (size_t k = 0; k < 3; k++) row[3 * x + k] = in[4 * x + k];
    good = std::fwrite(row.data(), sizeof(float), row.size(), file) == row.size();
  }
  good = std::fclose(file) == 0 && good;
  std::error_code error, none;
  if (good) std::filesystem::rename(partial, path, error);
  good = good && !error;
  if (!good) std::filesystem::remove(partial, none);
  return good;
}

void printStats(const Backend& backend, uint64_t frames) {
  RTstats s{};
  s.size = sizeof(s);
  backend.stats(s);
  std::printf("{\"frames\": %llu, \"triangles\": %llu, \"cameraRays\": %llu, \"shadowRays\": %llu, "
              "\"secondaryRays\": %llu,\n"
              " \"commitSeconds\": %g, \"buildSeconds\": %g, \"renderSeconds\": %g, \"threads\": "
              "%u, \"isa\": \"%s\", \"kernel\": \"%s\"}\n",
              static_cast<unsigned long long>(frames),
              static_cast<unsigned long long>(s.scene.triangles),
              static_cast<unsigned long long>(s.rays.camera),
              static_cast<unsigned long long>(s.rays.shadow),
              static_cast<unsigned long long>(s.rays.secondary), s.time.commit, s.time.build,
              s.time.render, s.machine.threads, s.machine.isa, s.machine.kernel);
}

int reportError(ExitCode code, const std::string& message) {
  std::fprintf(stderr, "openrt-replay: error: %s\n", printable(message).c_str());
  return code;
}

std::optional<Options> parseOptions(int argc, char** argv, int& exitCode) {
  Options options;
  CLI::App app(
      "Renders a recording made with backend=record or record=PATH and writes a frame as PFM.",
      "openrt-replay");
  app.add_option("recording", options.recording, "the file to replay")->required();
  app.add_option("-o,--output", options.output, "the picture to write (.pfm)");
  app.add_option("--frame", options.frame, "which frame, from 1 (default: the last)")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads,
                 "render threads (default: as many as the process may use)")
      ->check(CLI::Range(0, 1024));
  app.add_option("--isa", options.isa,
                 "instruction set of the ray kernels: avx512, avx2, avx, sse4.2, sse2, or neon on "
                 "ARM (default: auto, the best one of this machine)");
  app.add_option("--shader-path", options.shaderPath,
                 "folders with shader libraries, separated by colons");
  app.add_option("--export", options.exported,
                 "write the scene of the frame for other programs (JSON; arrays beside it in "
                 "FILE.bin), render nothing");
  app.add_flag("--stats", options.stats, "print counts and times as JSON");
  try {
    app.parse(optionWords(argc, argv, app));
  } catch (const CLI::ParseError& e) {
    exitCode = app.exit(e, std::cout, std::cerr) == 0 ? Done : Usage;
    return std::nullopt;
  }
  return options;
}

// Applies commits and renders their frames, up to the requested one. Exceptions of the reader pass
// through.
class Replay {
 public:
  Replay(RecordingReader& reader, Backend& backend) : reader_(reader), backend_(backend) {}

  // Returns false if the recording has no further frame.
  bool renderNext() {
    while (std::shared_ptr<const Commit> commit = reader_.next()) {
      for (const auto& entry : commit->edits.edits)
        if (const auto* frame = entry->any.AsFrameSettings()) settings_ = *frame;
      const bool render = commit->edits.render;
      backend_.apply(std::move(commit));
      if (!render) continue;
      backend_.start();
      backend_.wait();
      frames_++;
      return true;
    }
    return false;
  }
  uint64_t frames() const { return frames_; }

  std::optional<Picture> picture() const {
    Picture picture{settings_.width, settings_.height, {}};
    picture.rgba.resize(size_t(settings_.width) * settings_.height * 4);
    if (!(settings_.channels & RT_RGBA) || !backend_.read(RT_RGBA, picture.rgba))
      return std::nullopt;
    return picture;
  }

 private:
  RecordingReader& reader_;
  Backend& backend_;
  edit::FrameSettingsT settings_;
  uint64_t frames_ = 0;
};

int writeScene(const Options& options, RecordingReader& reader, const ShaderRegistry& shaders) {
  Scene scene;
  uint64_t frames = 0;
  try {
    while (options.frame == 0 || frames < options.frame) {
      const std::shared_ptr<const Commit> commit = reader.next();
      if (!commit) break;
      scene.apply(*commit);
      frames += commit->edits.render;
    }
  } catch (const BadRecording& e) { return reportError(InputUnusable, e.what()); }
  exportScene(scene, shaders, options.exported);
  return Done;
}

// Returns whether the file name has the suffix of the only format that is written, in any case.
// Devices and names without a suffix are accepted.
bool isNamedAsPfm(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return suffix.empty() || suffix == ".pfm";
}

int run(const Options& options) {
  for (const std::string& written : {options.output, options.exported}) {
    std::error_code none; // if one of them does not exist, they differ
    if (!written.empty() && std::filesystem::equivalent(written, options.recording, none))
      return reportError(Usage,
                         written + ": this is the recording that is read; choose another name");
  }
  if (!isNamedAsPfm(options.output))
    return reportError(Usage, "--output: a file name with the suffix pfm was expected, not \"" +
                                  options.output + "\"; only PFM files are written");
  const ShaderRegistry shaders(shaderFolders(options.shaderPath));
  std::unique_ptr<RecordingReader> reader;
  try {
    reader = openRecording(options.recording, &shaders);
  } catch (const std::exception& e) { return reportError(InputUnusable, e.what()); }
  if (!options.exported.empty()) return writeScene(options, *reader, shaders);
  BackendOptions backendOptions;
  backendOptions.threads = options.threads;
  backendOptions.isa = options.isa;
  backendOptions.shaders = &shaders;
  backendOptions.log = log;
  std::unique_ptr<Backend> backend;
  try {
    backend = makeLocalBackend(backendOptions);
  } catch (const OptionError& e) { return reportError(Usage, e.what()); }
  Replay replay(*reader, *backend);
  bool more = true;
  try {
    while (more && (options.frame == 0 || replay.frames() < options.frame))
      more = replay.renderNext();
  } catch (const BadRecording& e) { return reportError(InputUnusable, e.what()); }
  if (options.stats) printStats(*backend, replay.frames());
  if (replay.frames() < std::max<uint64_t>(options.frame, 1))
    return reportError(InputUnusable,
                       options.recording + ": has " + std::to_string(replay.frames()) + " frames");
  if (options.output.empty()) return Done;
  const std::optional<Picture> picture = replay.picture();
  if (!picture) return reportError(RenderFailed, "the frame has no colour channel");
  if (!writePfm(*picture, options.output))
    return reportError(RenderFailed, options.output + ": cannot be written");
  return Done;
}

} // namespace

int main(int argc, char** argv) {
  // A write beyond the file size limit then returns an error, and the file is removed.
  std::signal(SIGXFSZ, SIG_IGN);
  return withEnoughStack([&] {
    int exitCode = Done;
    try {
      const std::optional<Options> options = parseOptions(argc, argv, exitCode);
      if (options) exitCode = run(*options);
      if (exitCode == Done && !outputWritten())
        return int(reportError(RenderFailed, "standard output cannot be written"));
      return exitCode;
    } catch (const std::exception& e) { return int(reportError(RenderFailed, e.what())); }
  });
}
