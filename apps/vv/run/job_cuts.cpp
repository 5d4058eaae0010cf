#include "run/job_cuts.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace vv {

namespace {

double costOfJob(const SequenceCosts& costs, long long last, double drawing) {
  return costs.start + costs.step * double(last) + drawing;
}

// The pictures of a block, which are not cut.
struct Block {
  size_t first, last;
  double history, drawing; // seconds
};

std::vector<Block> blocksOf(const SequenceCosts& costs, const std::vector<long long>& numbers) {
  std::vector<Block> blocks;
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (i == 0 || numbers[i] / costs.block != numbers[i - 1] / costs.block)
      blocks.push_back({i, i, costs.history * costs.frames[i], 0});
    blocks.back().last = i;
    blocks.back().drawing += costs.frames[i];
  }
  return blocks;
}

// Returns how many jobs are needed if none costs more than `limit`, but for those of one block.
size_t cutByLimit(const SequenceCosts& costs, const std::vector<long long>& numbers, double limit,
                  std::vector<std::pair<size_t, size_t>>* pieces) {
  size_t count = 0;
  double drawing = 0;
  for (const Block& block : blocksOf(costs, numbers)) {
    drawing += block.drawing;
    if (count == 0 || costOfJob(costs, numbers[block.last], drawing) > limit) {
      ++count;
      drawing = block.history + block.drawing;
      if (pieces) pieces->emplace_back(block.first, block.last);
    }
    if (pieces) pieces->back().second = block.last;
  }
  return count;
}

// Returns a word as a shell reads it back.
std::string quoted(const std::string& word) {
  const auto isPlain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./:,=+@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), isPlain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

} // namespace

std::vector<std::pair<size_t, size_t>>
cutIntoJobs(const SequenceCosts& costs, const std::vector<long long>& numbers, size_t jobs) {
  std::vector<std::pair<size_t, size_t>> pieces;
  if (numbers.empty()) return pieces;
  double all = 0;
  for (const double cost : costs.frames) all += cost * (1 + costs.history);
  double low = 0, high = costOfJob(costs, numbers.back(), all);
  for (int i = 0; i < 60; ++i) { // halves the interval to the last bits
    const double middle = (low + high) / 2;
    (cutByLimit(costs, numbers, middle, nullptr) <= std::max<size_t>(1, jobs) ? high : low) =
        middle;
  }
  cutByLimit(costs, numbers, high, &pieces);
  return pieces;
}

std::string jobCommand(const std::vector<std::string>& words, const FrameRange& frames) {
  const std::string range = fmt::format("--frames {}-{}", frames.first, frames.last) +
                            (frames.step > 1 ? fmt::format("/{}", frames.step) : "");
  std::string command;
  bool areFiles = false; // words after "--"
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--" && !areFiles) {
      areFiles = true;
      command += ' ' + range;
    }
    if (areFiles) {
      command += ' ' + quoted(word);
      continue;
    }
    if (word == "--jobs" || word == "--frames") {
      ++i; // its value
      continue;
    }
    if (word.starts_with("--jobs=") || word.starts_with("--frames=")) continue;
    command += (command.empty() ? "" : " ") + quoted(word);
  }
  return areFiles ? command : command + ' ' + range;
}

} // namespace vv
