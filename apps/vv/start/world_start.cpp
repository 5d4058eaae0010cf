#include "start/world_start.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "options/definitions.h"
#include "process/messages.h"
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

} // namespace

xvrml::LoadOptions loadOptionsForShowing(const Options& options) {
  xvrml::LoadOptions load = options.load;
  const bool whole = !options.shaders.empty() || !options.definitions.empty() || options.script ||
                     !options.recordInput.empty() || options.strict;
  if (!whole) load.loadInlines = false;
  return load;
}

bool isOfCommandLine(const Options& options, const xvrml::World& world) {
  if (options.input.empty() || world.path == options.input) return true;
  std::error_code unknown; // a file that is gone, or standard input
  return std::filesystem::equivalent(world.path, options.input, unknown);
}

std::unique_ptr<xvrml::Browser> startWorld(std::unique_ptr<xvrml::World> world,
                                           const Options& options, Problems& problems) {
  problems.tell(*world);
  if (options.verbose)
    say(fmt::format("vv: {} nodes, parsed in {}, Inlines and prototypes in {}", world->nodeCount,
                    duration(world->times.parse), duration(world->times.load)));
  const bool changes = isOfCommandLine(options, *world);
  const std::vector<Definition> definitions =
      changes ? readDefinitions(options.definitions, *world) : std::vector<Definition>();
  for (const Definition& d : definitions)
    if (!d.asEvent) d.node->set(*d.field, d.value);
  if (changes) giveShaders(options, *world);
  std::unique_ptr<xvrml::Browser> browser = startScripts(std::move(world), options);
  for (const Definition& d : definitions)
    if (d.asEvent) browser->set(*d.node, d.field->name, d.value);
  problems.tell(browser->world());
  return browser;
}

} // namespace vv
