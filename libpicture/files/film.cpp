#include "libpicture/files/film.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace picture {

FilmKind filmOf(std::string_view path) {
  const size_t dot = path.rfind('.');
  std::string suffix(dot == path.npos ? "" : path.substr(dot + 1));
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  if (suffix == "mp4") return FilmKind::mp4;
  if (suffix == "webm") return FilmKind::webm;
  return suffix == "gif" ? FilmKind::gif : FilmKind::none;
}

std::string whyNoFilm(FilmKind kind) {
  if (kind == FilmKind::gif || libavEncodes(kind)) return "";
  return "this build has no encoder of such films (it lacks the ffmpeg libraries, or they lack "
         "it); a name that ends in .gif, or 'picture-{frame:4}.png' for single pictures, works";
}

Film::Film(FilmKind kind, int width, int height, double fps, const std::string& note)
    : bytes_(size_t(width) * size_t(height) * 3) {
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    throw std::runtime_error(
        fmt::format("a film of {}x{} pixels cannot be made: 1x1 to 16384x16384", width, height));
  if (!(fps > 0) || !std::isfinite(fps))
    throw std::runtime_error("a film needs a number of pictures a second above 0");
  if (const std::string why = whyNoFilm(kind); !why.empty()) throw std::runtime_error(why);
  encoder_ = kind == FilmKind::gif ? makeGifEncoder(width, height, fps, note)
                                   : makeLibavEncoder(kind, width, height, fps, note);
}

void Film::add(std::span<const uint8_t> rgb) {
  if (rgb.size() != bytes_) throw std::runtime_error("all pictures of a film have one size");
  encoder_->add(rgb);
  ++pictures_;
}

std::string Film::finish() {
  if (pictures_ == 0) throw std::runtime_error("a film needs at least one picture");
  return encoder_->finish();
}

} // namespace picture
