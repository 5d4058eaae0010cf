#include "start/world_start.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "libpicture/missing_parts.h"
#include "options/definitions.h"
#include "process/messages.h"
#include "report/missing_list.h"
#include "report/progress.h"
#include "steady_clock.h"

namespace vv {

namespace {

// Creates the Browser, which starts the Scripts; shows the progress if that takes long.
std::unique_ptr<xvrml::Browser> startScripts(std::unique_ptr<xvrml::World> world,
                                             const Options& options) {
  const auto progress = std::make_shared<std::unique_ptr<Progress>>(
      std::make_unique<Progress>("Scripts", options.quiet));
  xvrml::RunOptions run = options.run;
  run.epoch = options.epoch.value_or(xvrml::worldEpoch);
  // Scripts that start later run in the middle of other work.
  run.onScriptStart = [progress](const xvrml::ScriptCounts& counts) {
    if (*progress && counts.scripts > 0)
      (*progress)->show(1 - float(counts.waiting) / float(counts.scripts));
  };
  const double begin = steadySeconds();
  auto browser = std::make_unique<xvrml::Browser>(std::move(world), options.running, 0, run);
  progress->reset();
  const double seconds = steadySeconds() - begin;
  if (const xvrml::ScriptCounts counts = browser->scripts(); options.verbose && counts.scripts > 0)
    say(fmt::format("vv: {} of {} Scripts started in {}", counts.started, counts.scripts,
                    duration(seconds)));
  return browser;
}

void giveShaders(const Options& options, xvrml::World& world) {
  try {
    picture::applyShaderRules(options.shaders, options.render.shaderPath, world);
  } catch (const picture::ShaderError& error) { throw Failure{exitUsage, error.what()}; }
}

// Puts boxes in the place of missing parts if --placeholders asks for them, and lists the parts for
// that and for --check.
void treatMissingParts(const Options& options, xvrml::World& world) {
  if (!options.placeholders && !options.check) return;
  const std::vector<picture::MissingPart> parts = picture::missingParts(world);
  if (parts.empty()) return;
  const size_t boxes = options.placeholders ? picture::addPlaceholders(world) : 0;
  if (!options.quiet) say(missingText(parts, boxes, options.check || options.verbose));
}

} // namespace

xvrml::LoadOptions loadOptionsForShowing(const Options& options) {
  xvrml::LoadOptions load = options.load;
  const bool whole = !options.shaders.empty() || !options.definitions.empty() || options.script ||
                     !options.recordInput.empty() || options.strict || options.placeholders;
  if (!whole) load.loadInlines = false;
  return load;
}

bool isOfCommandLine(const Options& options, const xvrml::World& world) {
  if (options.input.empty() || world.path == options.input) return true;
  std::error_code unknown; // a file that is gone, or standard input
  return std::filesystem::equivalent(world.path, options.input, unknown);
}

std::unique_ptr<xvrml::Browser> startWorld(std::unique_ptr<xvrml::World> world,
                                           const Options& options, Problems& problems,
                                           const BeforeScripts& before) {
  problems.tell(*world);
  if (options.verbose)
    say(fmt::format("vv: {} nodes, parsed in {}, Inlines and prototypes in {}", world->nodeCount,
                    duration(world->times.parse), duration(world->times.load)));
  const bool changes = isOfCommandLine(options, *world);
  const std::vector<Definition> definitions =
      changes ? readDefinitions(options.definitions, *world) : std::vector<Definition>();
  for (const Definition& d : definitions)
    if (!d.asEvent) d.node->set(*d.field, d.value);
  treatMissingParts(options, *world);
  if (changes) giveShaders(options, *world);
  const bool sends = std::any_of(definitions.begin(), definitions.end(),
                                 [](const Definition& d) { return d.asEvent; });
  if (before && !sends) before(*world);
  std::unique_ptr<xvrml::Browser> browser = startScripts(std::move(world), options);
  for (const Definition& d : definitions)
    if (d.asEvent) browser->set(*d.node, d.field->name, d.value);
  if (before && sends) before(browser->world());
  problems.tell(browser->world());
  return browser;
}

} // namespace vv
