// look_library.h: The looks of a user's own files, and a picture of a ball with each look that can
// be chosen. Balls are rendered one after the other, each once, and kept until vv ends. Owned by
// the editor in the window. [the browser's thread; balls are rendered on one of their own]
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "edit/looks.h"

namespace vv {

// A square picture. Balls with different pixels have different numbers.
struct LookBall {
  static constexpr int side = 56; // pixels
  uint64_t number = 0;
  std::vector<uint8_t> rgb; // first row at the top; empty: the look cannot be drawn
};

class LookLibrary {
 public:
  ~LookLibrary() { interrupted_ = true; }

  // The looks of the user's files, as the last refresh() has found them.
  const std::vector<Look>& own() const { return own_; }
  // Reads the user's folder again.
  void refresh();
  // Returns the ball of a look; null: there is none, or not yet.
  const LookBall* ballOf(const Look& look) const;
  // Takes a ball that is finished, and begins the next one. mayRender: nothing else is to be drawn;
  // otherwise a ball that has been begun is given up, and begun anew later. Returns whether there
  // is a new ball.
  bool advance(const std::vector<Look>& installed, const std::string& shaderPath, bool mayRender);

 private:
  using Pixels = std::optional<std::vector<uint8_t>>; // none: it was interrupted

  void begin(const Look& look, const std::string& shaderPath);
  const Look* next(const std::vector<Look>& installed) const;

  std::vector<Look> own_;
  std::map<std::string, std::filesystem::file_time_type> changed_; // when each file was changed
  std::map<std::string, LookBall> balls_;                          // by keyOf() in the source
  uint64_t count_ = 0;                                             // balls so far
  std::string begun_;                                              // the key of the next ball
  std::atomic<bool> interrupted_{false};
  std::future<Pixels> rendering_; // the last member: it waits for a user of the one before
};

} // namespace vv
