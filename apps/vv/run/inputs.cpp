#include "run/inputs.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/sky/sky.h"
#include "process/messages.h"
#include "report/audit.h"

namespace vv {

namespace {

void checkReadable(const char* option, const std::string& path) {
  if (path.empty() || ::access(path.c_str(), R_OK) == 0) return;
  throw Failure{exitInput,
                fmt::format("{}: cannot read {}: {}", option, path, std::strerror(errno))};
}

} // namespace

void checkInputs(const Options& options) {
  checkReadable("--environment", options.render.environment);
  checkReadable("--background", options.render.background.file);
  checkReference(options);
}

void warnOfFolders(const Options& options) {
  if (options.quiet) return;
  const std::pair<const char*, const std::string&> paths[] = {
      {"--shader-path", options.render.shaderPath},
      {"--script-path", options.running.scriptPath},
      {"--node-path", options.nodePath}};
  for (const auto& [option, path] : paths)
    for (const std::string_view folder : split(path, ':')) {
      std::error_code error;
      if (!folder.empty() && !std::filesystem::is_directory(folder, error))
        sayWarning(fmt::format("{}: there is no folder {}", option, folder));
    }
}

void warnOfSky(const Options& options) {
  if (options.quiet || !options.render.sky) return;
  if (const std::string warning = picture::warningOf(*options.render.sky); !warning.empty())
    sayWarning("--sky: " + warning);
}

} // namespace vv
