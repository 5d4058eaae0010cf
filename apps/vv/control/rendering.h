// rendering.h: Renders for a client of the control channel: a picture, the pixel of a probe, or the
// readings of sensors. One at a time. [the browser's thread, while the session rests]
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "control/command.h"
#include "control/pictures_sent.h"
#include "control/probing.h"
#include "session/session.h"

namespace vv::control {

class Rendering {
 public:
  // Returns what is seen at a place of the picture, as JSON.
  using Describe = std::function<std::string(const Pick& place)>;
  struct Outcome {
    std::string result;        // JSON
    std::string code, failure; // why there is no result; "": there is one
  };

  explicit Rendering(const Options& options) : options_(options) {}

  // Tells whether a command is one of these: Render, Probe or Measure.
  static bool makes(const Command& command);
  // Tells whether one may begin.
  bool isFree(Session* session) const;
  // Throws CommandError, and what the library throws.
  void begin(const Command& command, Session& session, const Describe& describe);
  // Returns the outcome, once. session: null after its end.
  std::optional<Outcome> follow(Session* session);
  // Tells whether the world is not needed any more: the picture is being encoded or written.
  bool isEncoding() const { return std::holds_alternative<Encoding>(work_); }
  // Waits at most these seconds for the end of that. Returns whether it has ended.
  bool waitForFile(double seconds) const;
  // Gives up what is under way: no outcome follows.
  void giveUp(Session* session);

 private:
  // A picture that is rendered, and then encoded.
  struct Picture {
    Render render;
    uint32_t channels = 0;
  };
  // Readings of sensors, which are set when they are there.
  struct Reading {
    bool isProbe = false; // one point; otherwise all sensors of the world
    std::string hit;      // what is seen there, as JSON
    std::shared_ptr<std::optional<picture::LiveReadings>> read;
  };

  void begin(const Render& render, Session& session);
  void begin(const Probe& probe, Session& session, const Describe& describe);
  // sensors: none: those of the world. hit: of a probe.
  void measure(std::vector<picture::PlacedSensor> sensors, std::string hit,
               std::optional<int> samples, Session& session);
  std::optional<Outcome> follow(const Reading& reading);
  std::optional<Outcome> take(StillAnswer still);

  const Options& options_;
  std::variant<std::monostate, Picture, Probing, Reading, Encoding> work_;
};

} // namespace vv::control
