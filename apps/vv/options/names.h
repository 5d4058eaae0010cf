// names.h: the names of the files that a run with several pictures writes: {viewpoint} and
// {frame:4} in them. [any thread]
#pragma once

#include <optional>
#include <string>

namespace vv {

// What tells a picture from the others of the run.
struct PictureName {
  std::string viewpoint;          // empty: the only one
  std::optional<long long> frame; // nothing: no sequence

  std::string text() const; // for people: "front, frame 12"
};

// Throws UsageError if the braces of a {frame...} are wrong.
void checkFramePlace(const std::string& path);

// The path with {viewpoint} and {frame} (or {frame:DIGITS}) replaced; where they are missing and
// needed, "-NAME" and "-NUMBER" (four digits) are put before the suffix.
std::string pathFor(const std::string& path, const PictureName& name);

// The part of a file name that stands for a viewpoint's name.
std::string fileNamePart(const std::string& name);

} // namespace vv
