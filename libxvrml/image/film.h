// film.h: reads films of worlds (MPEG-1, MPEG-2, AVI, QuickTime and MP4, animated GIF), picture by
// picture. The ffmpeg libraries decode them, if the build has them. A FilmReader is for one thread;
// FilmData may be shared.
#pragma once

#include <memory>
#include <string>

#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

// The compressed pictures of a film in memory, shared by its readers. Immutable.
class FilmData {
 public:
  // Opens a film. Throws std::runtime_error with the reason: missing, not a film, damaged, too
  // large, or no decoder in this build. Only `path` is opened, whatever the film refers to.
  static std::shared_ptr<const FilmData> read(const std::string& path, const Limits& limits);
  ~FilmData();
  double duration() const; // seconds, above 0
  size_t pictures() const; // at least 1
  uint64_t bytes() const;  // size of the compressed pictures in memory
  // Returns the picture that is shown at a time since the beginning, clamped to the film.
  size_t pictureAt(double seconds) const;

  struct Impl;
  explicit FilmData(std::unique_ptr<Impl> impl);
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// Decodes pictures of a film in any order; forward is fastest.
class FilmReader {
 public:
  FilmReader(std::shared_ptr<const FilmData> film, const Limits& limits);
  ~FilmReader();
  // Decodes a picture: rows from the bottom up, 3 components, or 4 if the film has transparency.
  // Returns false, and leaves the image unchanged, if it cannot be decoded.
  bool read(size_t picture, Image& image);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns whether this build can decode films.
bool decodesFilms();

} // namespace xvrml
