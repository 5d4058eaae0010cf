// film.h: films that worlds name (MPEG-1, MPEG-2, AVI, QuickTime and MP4, animated GIF), picture by
// picture. Decoded by the ffmpeg libraries where the build has them. A Film is for one thread;
// FilmData may be shared.
#pragma once

#include <memory>
#include <string>

#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

// A film's compressed pictures in memory: what several readers share. Immutable.
class FilmData {
 public:
  // Throws std::runtime_error saying what is wrong: missing, no film, damaged, too large, or that
  // this build decodes none. No other file than `path` is opened, whatever the film refers to.
  static std::shared_ptr<const FilmData> read(const std::string& path, const Limits& limits);
  ~FilmData();
  double duration() const; // seconds, above 0
  size_t pictures() const; // at least 1
  uint64_t bytes() const;  // of the compressed pictures in memory
  // The picture that is shown at a time from the beginning (clamped to the film).
  size_t pictureAt(double seconds) const;

  struct Impl;
  explicit FilmData(std::unique_ptr<Impl> impl);
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// Decodes pictures of a film in any order; quickest forward.
class FilmReader {
 public:
  FilmReader(std::shared_ptr<const FilmData> film, const Limits& limits);
  ~FilmReader();
  // Rows from the bottom up, 3 components, or 4 if the film has transparency. What cannot be
  // decoded leaves the image as it was and is false.
  bool read(size_t picture, Image& image);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Whether this build can decode films at all.
bool decodesFilms();

} // namespace xvrml
