#include "run/film_join.h"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "libpicture/files/film.h"
#include "libpicture/files/read_note.h"
#include "process/messages.h"
#include "process/signals.h"
#include "report/describe.h"
#include "run/outputs.h"
#include "run/picture_files.h"
#include "xvrml/image.h"

namespace vv {

namespace {

xvrml::Image read(const std::string& path) {
  try {
    return xvrml::loadImage(path);
  } catch (const std::runtime_error& error) {
    throw Failure{exitInput, fmt::format("vv film: {}: {}", path, error.what())};
  }
}

// Returns the red, green and blue of a picture, the first row at the top. A clear pixel is black.
std::vector<uint8_t> rgbOf(const xvrml::Image& image) {
  const size_t parts = size_t(image.components), width = size_t(image.width),
               height = size_t(image.height);
  const bool isGrey = parts < 3, hasAlpha = parts % 2 == 0;
  std::vector<uint8_t> rgb;
  rgb.reserve(3 * width * height);
  for (size_t y = height; y-- > 0;)
    for (size_t x = 0; x < width; ++x) {
      const uint8_t* const pixel = image.pixels.data() + (y * width + x) * parts;
      const unsigned alpha = hasAlpha ? pixel[parts - 1] : 255;
      for (size_t k = 0; k < 3; ++k)
        rgb.push_back(uint8_t((pixel[isGrey ? 0 : k] * alpha + 127) / 255));
    }
  return rgb;
}

// Returns what the first picture says that says anything: a film of previews is a preview.
std::string noteOf(const std::vector<std::string>& pictures) {
  for (const std::string& path : pictures)
    if (std::string note = picture::readNote(path); !note.empty()) return note;
  return "";
}

} // namespace

int joinFilm(const Options& options) {
  checkOutputs(options);
  std::vector<std::pair<const Output*, std::unique_ptr<picture::Film>>> films;
  int width = 0, height = 0;
  const std::string note = noteOf(options.joined);
  for (const std::string& path : options.joined) {
    if (interrupted()) return exitInterrupted;
    const xvrml::Image image = read(path);
    if (films.empty()) {
      width = image.width;
      height = image.height;
      for (const Output& output : options.outputs)
        films.emplace_back(&output, std::make_unique<picture::Film>(output.film, width, height,
                                                                    options.fps, note));
    }
    if (image.width != width || image.height != height)
      throw Failure{exitInput,
                    fmt::format("vv film: {} has {}x{} pixels, but {} has {}x{}", path, image.width,
                                image.height, options.joined.front(), width, height)};
    const std::vector<uint8_t> rgb = rgbOf(image);
    for (auto& [output, film] : films) film->add(rgb);
  }
  for (auto& [output, film] : films) writeOutput(*output, output->path, film->finish());
  if (!options.quiet) say(fmt::format("vv: joined {}", counted(options.joined.size(), "picture")));
  return exitDone;
}

} // namespace vv
