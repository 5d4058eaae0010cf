// film.h: Encodes a sequence of pictures as a film in memory: MP4 and WebM with the ffmpeg
// libraries if the build has them, animated GIF with giflib always. vv and the Python binding write
// the bytes with writeFile() when the film is finished, so a file is complete or absent. The same
// pictures give the same bytes. [one thread at a time for each Film]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace picture {

enum class FilmKind { none, mp4, webm, gif };
inline constexpr std::string_view filmSuffixes = "mp4, webm, gif";

// Returns the kind of film for a file name's suffix in any case; none for every other suffix.
FilmKind filmOf(std::string_view path);

// Returns why this build cannot encode such a film, as a clause that says what to do instead; "" if
// it can.
std::string whyNoFilm(FilmKind kind);

// Encodes one kind of film; implemented in film_gif.cpp and film_libav.cpp.
class FilmEncoder {
 public:
  virtual ~FilmEncoder() = default;
  virtual void add(std::span<const uint8_t> rgb) = 0;
  virtual std::string finish() = 0;
};

class Film {
 public:
  // width, height: size of all pictures, in pixels (1 to 16384); fps: pictures per second, above 0.
  // MP4 and WebM halve the resolution of colour, so an odd width or height gets a black column or
  // row. note: what the file says about its pictures, a line of ASCII; "": nothing. Throws
  // std::runtime_error.
  Film(FilmKind kind, int width, int height, double fps, const std::string& note = "");
  // Appends a picture: 8-bit red, green, blue, first row at the top, width * height * 3 bytes.
  // Throws std::runtime_error.
  void add(std::span<const uint8_t> rgb);
  // Returns the bytes of the file; nothing can be added afterwards. Throws std::runtime_error if
  // there is no picture.
  std::string finish();

 private:
  std::unique_ptr<FilmEncoder> encoder_;
  size_t bytes_, pictures_ = 0;
};

// Returns an encoder of animated GIF.
std::unique_ptr<FilmEncoder> makeGifEncoder(int width, int height, double fps,
                                            const std::string& note);
// Returns an encoder of MP4 or WebM, or null in a build without the ffmpeg libraries. Throws
// std::runtime_error.
std::unique_ptr<FilmEncoder> makeLibavEncoder(FilmKind kind, int width, int height, double fps,
                                              const std::string& note);
// Returns whether makeLibavEncoder() can make this kind.
bool libavEncodes(FilmKind kind);

} // namespace picture
