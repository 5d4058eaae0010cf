// xvrml_film.cpp: decodes arbitrary bytes as a film: the first, a middle and the last picture.
// libFuzzer calls this on one thread.
#include <stdexcept>

#include "fuzz_file.h"
#include "image/film.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  const FuzzFile file(data, size);
  xvrml::Limits limits;
  limits.imagePixels = 1 << 16;
  const auto film = xvrml::FilmData::read(file.path(), limits);
  if (!(film->duration() > 0) || film->pictures() < 1 ||
      film->pictureAt(film->duration() * 2) >= film->pictures())
    __builtin_trap();
  xvrml::FilmReader reader(film, limits);
  xvrml::Image image;
  for (const size_t picture : {size_t(0), film->pictures() / 2, film->pictures() - 1})
    reader.read(picture, image);
  if (image.pixels.size() != size_t(image.width) * size_t(image.height) * size_t(image.components))
    __builtin_trap();
  return 0;
} catch (const std::runtime_error&) { return 0; }
