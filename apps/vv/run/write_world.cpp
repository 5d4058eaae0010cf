#include "run/write_world.h"

#include <fmt/format.h>

#include "libpicture/bare_model.h"
#include "process/messages.h"
#include "run/outputs.h"
#include "run/picture_files.h"
#include "start/world_clock.h"

namespace vv {

namespace {

void exportWorld(const Options& options, const xvrml::World& world) {
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

} // namespace

void writeWorld(const Options& options, xvrml::Browser& browser) {
  if (options.writeFormat) {
    if (options.time) WorldClock(browser, options.fps).advance(*options.time);
    return exportWorld(options, browser.world());
  }
  if (!options.quiet) {
    for (const std::string& change :
         xvrml::changesByWriting(browser.world(), options.writeEncoding))
      sayWarning("--write: " + change);
    if (picture::losesLook(browser.world()))
      sayWarning("--write: outside of glTF a model with a camera or a shader is a world: it is "
                 "shown before black, and no longer before the backdrop of vv");
  }
  // Relative URLs of a text for standard output stay as they are.
  writeText(options.write,
            xvrml::writeWorld(browser.world(), options.write == "-" ? "" : options.write,
                              options.writeEncoding));
}

} // namespace vv
