// job_cuts.h: Cuts a sequence into jobs of about equal cost, and writes their commands. [any
// thread]
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "options/values.h"

namespace vv {

// Seconds that the parts of a sequence take. A job that begins with frame n steps the world n times
// before.
struct SequenceCosts {
  double start = 0;           // reading the world and building it
  double step = 0;            // a step of the world's clock
  std::vector<double> frames; // drawing each picture
  // A job begins with a frame of another block than the one before it, and draws so many frames
  // that are not its own before.
  long long block = 1;
  double history = 0;
};

// Cuts the pictures of a sequence into at most `jobs` pieces, the most expensive of which costs as
// little as possible. numbers: of the frames, rising. Returns the first and last index of each.
std::vector<std::pair<size_t, size_t>>
cutIntoJobs(const SequenceCosts& costs, const std::vector<long long>& numbers, size_t jobs);

// Returns the command of one job: the words of the whole with other frames and without --jobs,
// quoted for a shell.
std::string jobCommand(const std::vector<std::string>& words, const FrameRange& frames);

} // namespace vv
