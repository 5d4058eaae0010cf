#include "run/checkpoint.h"

#include <filesystem>

#include <fmt/format.h>

#include "libpicture/background.h"
#include "libpicture/files/atomic_file.h"
#include "report/progress.h"

namespace vv {

namespace {

// The writes of the file take at most this share of the time.
constexpr double shareOfWrites = .02;

std::string seedsOf(uint32_t first, uint32_t last) {
  return first == last ? fmt::format("the seed {}", first)
                       : fmt::format("the seeds {}-{}", first, last);
}

picture::SumsView viewOf(const Options& options) {
  return {options.render.view, options.fitExposure};
}

// Replaces the numbers that belong to the picture by those of its sums.
void useStatsOf(const picture::Sums& all, RTstats& stats) {
  const RTstats sums = picture::statsOf(all);
  stats.rays = sums.rays;
  stats.error = sums.error;
  stats.leftOut = sums.leftOut;
}

} // namespace

Checkpoint::Checkpoint(const Options& options) : options_(options), savedAt_(secondsSinceStart()) {
  file_.facts = picture::factsOf(options.render, options.render.channels, {});
  file_.view = viewOf(options);
  std::error_code error;
  if (!writes() || !std::filesystem::exists(options.resume, error)) return;
  const auto refuse = [&](int code, const std::string& why) {
    throw Failure{code, fmt::format("--resume: cannot continue from {}: {}; it is left as it is",
                                    options.resume, why)};
  };
  try {
    file_ = picture::readSums(options.resume);
  } catch (const picture::InputError& wrong) {
    throw Failure{exitInput, fmt::format("--resume: {}; the file is left as it is", wrong.what())};
  }
  file_.view = viewOf(options); // it changes no sums
  const SeedRange& seeds = options.seeds;
  if (!file_.current)
    refuse(exitUsage, "it has the sums of finished pictures alone, with which vv merge works");
  picture::SumsFacts wanted = picture::factsOf(options.render, options.render.channels, {});
  wanted.names = file_.facts.names;
  if (!(wanted == file_.facts))
    refuse(exitUsage, "its picture has another --channels, --colour, --depth-along or "
                      "--background");
  const RTsumsInfo current = file_.current.info();
  uint32_t begin = current.firstSeed;
  if (file_.done) {
    const RTsumsInfo done = file_.done.info();
    if (done.samples != uint32_t(options.render.samples))
      refuse(exitUsage, fmt::format("its finished seeds have {} samples a pixel, and --spp is {}",
                                    done.samples, options.render.samples));
    begin = done.firstSeed;
    if (done.lastSeed + 1 != current.firstSeed || done.seeds != current.firstSeed - done.firstSeed)
      refuse(exitInput, "it is damaged: its seeds are not in order");
  }
  if (begin != seeds.first || current.firstSeed > seeds.last)
    refuse(exitUsage,
           fmt::format("it has {}, and {} is asked for", seedsOf(begin, current.firstSeed),
                       seedsOf(seeds.first, seeds.last)));
}

uint32_t Checkpoint::firstSeed() const {
  return file_.current ? file_.current.info().firstSeed : options_.seeds.first;
}

picture::Sums Checkpoint::begin(uint32_t seed) {
  seed_ = seed;
  return file_.current && file_.current.info().firstSeed == seed ? file_.current : picture::Sums();
}

bool Checkpoint::due() const {
  const double now = secondsSinceStart();
  return writes() && now - savedAt_ >= options_.resumeEvery &&
         (now - savedAt_) * shareOfWrites >= saveSeconds_;
}

void Checkpoint::save(const picture::Sums& sums, const std::vector<std::string>& names) {
  if (!sums || sums.info().firstSeed != seed_) return;
  file_.current = sums;
  file_.facts.names = names;
  if (!writes()) return;
  const double begin = secondsSinceStart();
  try {
    // A lost machine leaves the old file or the new one.
    picture::writeFile(options_.resume, picture::encodeSums(file_), picture::Wait::disk);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("--resume: {}", error.what()));
  }
  savedAt_ = secondsSinceStart();
  saveSeconds_ = savedAt_ - begin;
}

void Checkpoint::nextSeed() {
  file_.done = picture::mergeSums(file_.done, file_.current);
  file_.current = {};
}

picture::Sums Checkpoint::all() const { return picture::mergeSums(file_.done, file_.current); }

void Checkpoint::useAll(picture::RenderResult& result) const {
  const picture::Sums all = this->all();
  result.picture.planes = picture::pictureOf(all, file_.facts).planes;
  if (const auto rgba = result.picture.planes.find(RT_RGBA);
      rgba != result.picture.planes.end() &&
      options_.render.background.kind == picture::Background::Kind::file)
    picture::BackgroundLayer(options_.render.background, options_.render.linear)
        .compositeOver(rgba->second, result.picture.width, result.picture.height);
  useStatsOf(all, result.stats);
}

picture::SumsFile Checkpoint::behindPixels() const { return {file_.facts, file_.view, all(), {}}; }

bool Checkpoint::timeIsUp() const {
  return writes() && options_.render.timeLimit > 0 &&
         secondsSinceStart() >= options_.render.timeLimit;
}

} // namespace vv
