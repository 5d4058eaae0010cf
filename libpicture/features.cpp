#include "libpicture/features.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "libpicture/files/film.h"
#include "libpicture/live/oidn.h"
#include "system/process.h"
#include "xvrml/file_head.h"
#include "xvrml/script_engines.h"

namespace picture {

namespace {

Feature denoising() {
  Feature row{.name = "denoise",
              .text = "pictures without noise (--denoise) and better previews",
              .how = live::howToGetOidn};
  try {
    if (const auto library = live::OidnLibrary::findTried())
      row = {row.name, row.text, true, library->name(), library->file(), ""};
    else
      row.detail = "Open Image Denoise 2 was not found";
  } catch (const std::exception& error) { row.detail = error.what(); }
  return row;
}

Feature film(FilmKind kind, const char* name) {
  Feature row{.name = name, .text = fmt::format("films as .{}", name)};
  row.available = whyNoFilm(kind).empty();
  if (row.available)
    row.detail = kind == FilmKind::gif ? "giflib" : "the ffmpeg libraries";
  else
    row.how = "build with the ffmpeg libraries and an encoder of such films (Debian: "
              "libavcodec-dev libavformat-dev libswscale-dev); .gif always works";
  return row;
}

// A script engine that this project has, and how to build it.
struct KnownEngine {
  const char *name, *text, *how;
};
constexpr KnownEngine engines[] = {
    {"ecmascript", "Scripts in ECMAScript (javascript:, vrmlscript:)",
     "build with QuickJS (Debian 13: libquickjs) or Duktape 2 (Debian: duktape-dev)"},
    {"tcl", "Scripts in Tcl", "build with Tcl 8.6 (Debian: tcl-dev)"},
    {"python", "Scripts in Python, in trusted worlds",
     "build with Python that can be embedded and pybind11 (Debian: python3-dev pybind11-dev)"},
    {"native", "Scripts in C, in trusted worlds", "build with libffi (Debian: libffi-dev)"},
};

void addEngines(std::string_view scriptPath, std::vector<Feature>& rows) {
  const std::vector<xvrml::ScriptEngineInfo> found = xvrml::scriptEngines(scriptPath);
  for (const KnownEngine& known : engines) {
    const auto engine = std::find_if(found.begin(), found.end(),
                                     [&](const auto& one) { return one.name == known.name; });
    Feature row{.name = known.name, .text = known.text};
    if (engine == found.end())
      row.how = fmt::format("{}; --script-path names a folder with other engines", known.how);
    else
      row = {row.name, row.text, true, engine->text, engine->library, ""};
    rows.push_back(std::move(row));
  }
  for (const xvrml::ScriptEngineInfo& engine : found) // those of others
    if (std::none_of(std::begin(engines), std::end(engines),
                     [&](const KnownEngine& known) { return engine.name == known.name; }))
      rows.push_back({engine.name, "Scripts: " + engine.text, true, "", engine.library, ""});
}

Feature stepModels() {
  Feature row{.name = "step", .text = "models in STEP (.step, .stp)"};
  const std::string why = xvrml::whyNotReadable(xvrml::Encoding::step);
  row.available = why.empty();
  row.detail = row.available ? "Open CASCADE" : why;
  if (!row.available) row.how = "build with Open CASCADE 7.6 (Debian: libocct-data-exchange-dev)";
  return row;
}

Feature sandbox() {
  Feature row{.name = "seccomp",
              .text = "a filter of system calls around Scripts and decoders of worlds"};
#ifdef PICTURE_WITH_SECCOMP
  row.available = os::canFilterCalls();
  if (row.available)
    row.detail = "libseccomp";
  else
    row.how = "a Linux kernel with CONFIG_SECCOMP_FILTER; both run without the filter";
#else
  row.how = "build with libseccomp (Debian: libseccomp-dev); both run without the filter";
#endif
  return row;
}

} // namespace

std::vector<Feature> listFeatures(std::string_view scriptPath) {
  std::vector<Feature> rows{denoising(), film(FilmKind::mp4, "mp4"), film(FilmKind::webm, "webm"),
                            film(FilmKind::gif, "gif")};
  addEngines(scriptPath, rows);
  rows.push_back(sandbox());
  rows.push_back(stepModels());
  return rows;
}

} // namespace picture
