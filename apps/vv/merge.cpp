// merge.cpp: vv merge: adds the sums of pictures that differ in their seeds alone, and writes the
// picture of them. No world is read.
#include <fmt/format.h>
#include <unistd.h>

#include "checkpoint.h"
#include "libpicture/files/atomic_file.h"
#include "outputs.h"
#include "pictures.h"
#include "report/audit.h"
#include "report/messages.h"
#include "report/report.h"

namespace vv {

namespace {

// Reads a file and returns its sums, without what is needed to continue it.
picture::SumsFile readPart(const std::string& path) {
  picture::SumsFile file = picture::readSums(path);
  file.done = picture::mergeSums(file.done, file.current);
  file.current = {};
  if (file.facts.background.kind == picture::Background::Kind::file)
    throw picture::RenderError("its background is a picture, which it does not hold",
                               RT_SUMS_ERROR);
  return file;
}

picture::SumsFile addAll(const std::vector<std::string>& paths) {
  picture::SumsFile all;
  std::vector<picture::Sums> waiting;
  for (const std::string& path : paths) {
    try {
      picture::SumsFile part = readPart(path);
      if (all.done && !(part.facts == all.facts))
        throw picture::RenderError("it was made with another --channels, --colour, --depth-along "
                                   "or --background, or of another world, than the files before",
                                   RT_SUMS_ERROR);
      all.facts = part.facts;
      all.done = picture::mergeSums(all.done, part.done);
    } catch (const picture::InputError& error) {
      throw Failure{exitInput, fmt::format("vv merge: {}", error.what())};
    } catch (const picture::RenderError& error) {
      throw Failure{exitUsage, fmt::format("vv merge: cannot add {}: {}", path, error.what())};
    }
  }
  return all;
}

} // namespace

int runMerge(const Options& options, const std::string& commandLine) {
  checkOutputs(options);
  const picture::SumsFile all = addAll(options.merge);
  const picture::Picture made = picture::pictureOf(all.done, all.facts);
  const picture::Picture wanted = wantedPart(made, all.facts.channels);
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
