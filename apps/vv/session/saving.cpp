#include "session/saving.h"

#include <filesystem>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "libpicture/false_colour.h"
#include "libpicture/files/atomic_file.h"
#include "libpicture/files/formats.h"
#include "options/names.h"
#include "process/messages.h"

namespace vv {

namespace {

// Returns the value of --samples, or else what the other options give, or else `standard`.
int samplesOf(const Options& options, int standard) {
  const bool open = options.render.timeLimit > 0 || options.render.error > 0;
  return options.samples.value_or(open ? options.render.samples : standard);
}

} // namespace

int samplesInWindow(const Options& options) { return samplesOf(options, 256); }
int samplesOfSensors(const Options& options) { return samplesOf(options, Options::measureSamples); }

std::string freeName(const std::string& world, const std::string& suffix) {
  std::string stem = fileNamePart(std::filesystem::path(world).stem().string());
  if (stem.empty()) stem = "vv";
  for (int i = 1; i < 100'000; ++i) {
    std::string name = fmt::format("{}-{}.{}", stem, i, suffix);
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(name, error))) return name;
  }
  return fmt::format("{}.{}", stem, suffix);
}

PictureWriter::~PictureWriter() {
  wait();
  takeMessage(); // says it on the terminal
}

void PictureWriter::begin(picture::Picture picture, const std::string& path, uint32_t channels,
                          std::optional<double> falseColour, const std::string& note) {
  wait();
  takeMessage();
  done_ = false;
  thread_ = std::thread([this, picture = std::move(picture), path, channels, falseColour, note] {
    try {
      const picture::Format* format = picture::formatOf(path);
      if (!format)
        throw std::runtime_error(
            fmt::format("{}: the suffix is none of {}", path, picture::formatSuffixes()));
      const auto most = falseColour.value_or(0) > 0 ? falseColour : std::nullopt;
      picture::writeRegularFile(path,
                                format->encode(falseColour && format->appliesCurve
                                                   ? picture::falseColours(picture, most)
                                                   : picture::withChannels(picture, channels)));
      told_ = "saved as " + path + note;
      failed_ = false;
    } catch (const std::bad_alloc&) {
      told_ = path + " was not saved: not enough memory";
      failed_ = true;
    } catch (const std::exception& error) {
      told_ = error.what();
      failed_ = true;
    }
    done_ = true;
  });
}

void PictureWriter::wait() {
  if (thread_.joinable()) thread_.join();
}

std::string PictureWriter::takeMessage() {
  if (!done_) return {};
  wait();
  if (told_.empty()) return {};
  if (failed_)
    sayError(told_);
  else
    say("vv: " + told_);
  return std::exchange(told_, {});
}

} // namespace vv
