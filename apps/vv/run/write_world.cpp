#include "run/write_world.h"

#include <utility>

#include "libpicture/bare_model.h"
#include "process/messages.h"
#include "run/outputs.h"
#include "run/picture_files.h"
#include "start/world_clock.h"

namespace vv {

WorldText textOf(const Options& options, const xvrml::World& world) {
  // Relative URLs of a text for standard output stay as they are.
  const std::string path = options.write == "-" ? "" : options.write;
  WorldText made{xvrml::writeWorld(world, path, options.writeEncoding), {}};
  if (options.quiet) return made;
  made.changes = xvrml::changesByWriting(world, path, options.writeEncoding);
  if (std::string change = picture::changeOfLook(world); !change.empty())
    made.changes.push_back(std::move(change));
  return made;
}

void writeWorld(const Options& options, const WorldText& world) {
  for (const std::string& change : world.changes) sayWarning("--write: " + change);
  writeText(options.write, world.text);
}

void exportWorld(const Options& options, xvrml::Browser& browser) {
  if (options.time) WorldClock(browser, options.fps).advance(*options.time);
  const xvrml::World& world = browser.world();
  const picture::Exported exported =
      options.writeFormat->make(world, {options.write, options.render.shaderPath});
  for (const picture::Exported::File& file : exported.files) protectFilesOf(world, file.path);
  if (options.write == "-")
    for (const std::string& piece : exported.files[0].pieces) writeData(piece);
  else
    picture::writeExported(exported);
  if (options.quiet) return;
  for (const std::string& remark : exported.remarks) sayWarning("--write: " + remark);
}

} // namespace vv
