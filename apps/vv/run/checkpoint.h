// checkpoint.h: Owns the sums of the picture that a run makes (--resume, --sums, --seed A-B): reads
// and writes the file of --resume, and adds the sums of seeds. Used by Pictures. [main thread]
#pragma once

#include <cstdint>
#include <string>

#include "libpicture/renderer.h"
#include "libpicture/sums.h"
#include "options/options.h"

namespace vv {

class Checkpoint {
 public:
  // Reads the file of --resume, if there is one. Throws Failure if it is damaged, or of other
  // seeds; it is left as it is. channels: those of the files.
  explicit Checkpoint(const Options& options);

  // Returns the seed to begin with.
  uint32_t firstSeed() const;
  // Returns the sums that the seed continues from; none: it begins anew.
  picture::Sums begin(uint32_t seed);
  // Tells whether the file should be written now.
  bool due() const;
  // Takes the sums so far of the seed in work, and writes the file. Nothing is done if there are
  // none, or if they are those of the seed before.
  void save(const picture::Sums& sums, const std::vector<std::string>& names);
  // Adds the finished sums of the seed in work; another seed follows.
  void nextSeed();
  // Replaces the picture of the last seed, and its statistics, by those of all seeds. Throws
  // picture::RenderError.
  void useAll(picture::RenderResult& result) const;
  // Returns what goes behind the pixels of an EXR file.
  picture::SumsFile behindPixels() const;
  // Tells whether the process must end because of --time-limit.
  bool timeIsUp() const;
  bool writes() const { return !options_.resume.empty(); }

 private:
  picture::Sums all() const; // the sums of all seeds that are finished

  const Options& options_;
  picture::SumsFile file_;
  uint32_t seed_ = 0;                    // the seed in work
  double savedAt_ = 0, saveSeconds_ = 0; // end and length of the last write
};

// Adds the sums of files (vv merge). Returns the exit code; throws Failure.
int runMerge(const Options& options, const std::string& commandLine);

} // namespace vv
