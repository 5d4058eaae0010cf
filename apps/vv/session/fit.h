// fit.h: Keeps the request to show the whole world. A world's extent is known only when a frame has
// read the world, so the request passes through states. Owned by a session. [the browser's thread]
#pragma once

#include <cstdint>

namespace vv {

class Fit {
 public:
  // The transitions are none -> wanted (want), wanted -> mapping (begin), mapping -> none (end).
  enum class State : uint8_t {
    none,   // the viewer is where the user or the world has put it
    wanted, // the next frame must begin at once, because it reads the world
    mapping // that frame reads the world; afterwards the viewer is placed
  };
  enum class Direction : uint8_t {
    initial, // the view of the options, or from the front
    current  // the viewer's direction
  };
  enum class Repeat : uint8_t { never, whenLoaded };

  State state() const { return state_; }
  bool isPending() const { return state_ != State::none; }
  bool isWanted() const { return state_ == State::wanted; }
  Direction direction() const { return direction_; }

  void want(Direction direction) {
    state_ = State::wanted;
    direction_ = direction;
  }
  // Notes that a frame has been started.
  void begin() {
    if (state_ == State::wanted) state_ = State::mapping;
  }
  // Notes that the viewer has been placed.
  void end() { state_ = State::none; }

  // Chooses whether the fit is repeated when the Inlines are loaded, because the picture shows the
  // whole world so far.
  void setRepeat(Repeat repeat) { repeat_ = repeat; }
  Repeat repeat() const { return repeat_; }

 private:
  State state_ = State::none;
  Direction direction_ = Direction::initial;
  Repeat repeat_ = Repeat::never;
};

} // namespace vv
