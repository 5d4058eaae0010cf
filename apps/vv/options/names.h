// names.h: Expands {viewpoint} and {frame:4} in the names of files that a run with several pictures
// writes. [any thread]
#pragma once

#include <optional>
#include <string>

namespace vv {

// Identifies one of the run's pictures.
struct PictureName {
  std::string viewpoint;          // empty: the run has one viewpoint
  std::optional<long long> frame; // nothing: the run is not a sequence

  std::string text() const; // for people: "front, frame 12"
};

// Throws UsageError if the braces of a {frame...} are wrong.
void checkFramePlace(const std::string& path);

// Returns the path with {viewpoint} and {frame} (or {frame:DIGITS}) replaced. If a needed
// placeholder is missing, "-NAME" or "-NUMBER" (four digits) is inserted before the suffix.
std::string pathFor(const std::string& path, const PictureName& name);

// Converts a viewpoint's name to a part of a file name.
std::string fileNamePart(const std::string& name);

} // namespace vv
