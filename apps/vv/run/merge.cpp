// merge.cpp: vv merge: adds the sums of pictures that differ in their seeds alone, and writes the
// picture of them. No world is read.
#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/files/atomic_file.h"
#include "libpicture/sums_merge.h"
#include "process/messages.h"
#include "report/audit.h"
#include "report/report.h"
#include "run/checkpoint.h"
#include "run/outputs.h"
#include "run/picture_files.h"

namespace vv {

namespace {

picture::MergedPicture addAll(const std::vector<std::string>& paths) {
  try {
    return picture::mergePictures(paths);
  } catch (const picture::InputError& error) {
    throw Failure{exitInput, fmt::format("vv merge: {}", error.what())};
  } catch (const picture::RenderError& error) {
    throw Failure{exitUsage, fmt::format("vv merge: {}", error.what())};
  }
}

} // namespace

int runMerge(const Options& options, const std::string& commandLine) {
  checkOutputs(options);
  const auto [all, made, warning] = addAll(options.merge);
  if (!options.quiet && !warning.empty()) sayWarning(warning);
  if (!options.quiet && all.view.fits)
    say(fmt::format("vv: --exposure auto is {:g} for this picture", made.view.exposure));
  const picture::Picture wanted = picture::withChannels(made, all.facts.channels);
  for (const Output& output : options.outputs) {
    std::string bytes = output.format->encode(wanted);
    if (options.sums && output.format->encode == picture::encodeExr)
      picture::appendSums(bytes, all);
    if (output.path == "-")
      picture::writeDescriptor(STDOUT_FILENO, bytes, "standard output");
    else
      picture::writeFile(output.path, bytes);
  }
  if (!options.compare.empty()) writeOut(compareText(made, options.compare));
  if (!options.stats.empty())
    writeText(options.stats, mergedStatsJson(commandLine, all.done, picture::statsOf(all.done)));
  const RTsumsInfo info = all.done.info();
  if (!options.quiet)
    say(fmt::format("vv: added {} {} of {} samples per pixel", info.seeds,
                    info.seeds == 1 ? "seed" : "seeds", info.samples));
  return exitDone;
}

} // namespace vv
