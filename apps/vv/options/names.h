// names.h: Expands {viewpoint} and {frame:4} in the names of files that a run with several pictures
// writes. [any thread]
#pragma once

#include <optional>
#include <string>

namespace vv {

// Identifies one of the run's pictures.
struct PictureName {
  std::string viewpoint;          // viewpoint's name; empty if the run has only one
  std::optional<long long> frame; // frame's number; empty if the run is not a sequence

  // Returns the name for messages, such as "front, frame 12".
  std::string text() const;
};

// Throws UsageError if the braces of a {frame...} are wrong.
void checkFramePlace(const std::string& path);

// Returns the path with {viewpoint} and {frame} (or {frame:DIGITS}) replaced. If a needed
// placeholder is missing, "-NAME" or "-NUMBER" (four digits) is inserted before the suffix.
std::string pathFor(const std::string& path, const PictureName& name);

// Converts a viewpoint's name to a part of a file name.
std::string fileNamePart(const std::string& name);

} // namespace vv
