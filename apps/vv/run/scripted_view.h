// scripted_view.h: Drives the world and its camera with the events of --input, as the window would.
// [main thread]
#pragma once

#include <optional>

#include "options/options.h"
#include "session/replay.h"

namespace vv {

class ScriptedView {
 public:
  // Begins at the viewpoint of `view`. Only the renderer knows the extent of the world, which a
  // view of the whole world needs. The arguments must live as long.
  ScriptedView(const Options& options, xvrml::Browser& browser, picture::Renderer& renderer,
               const picture::View& view);
  ScriptedView(const ScriptedView&) = delete;
  ScriptedView& operator=(const ScriptedView&) = delete;

  // Returns the time of the step whose end shows the moment, as in the window, so that its events
  // have happened.
  double instantOf(double time) const;
  // Advances the world, with the script's events.
  void step(double time) { replay_.step(time); }
  // Returns the view of the moment, and gives its headlight and exposure to the renderer.
  picture::View view();
  // Returns the end of the scale of false colours, 0: chosen by the first picture; none: they are
  // not wanted.
  std::optional<double> falseColour() const { return pilot_.falseColour(); }

 private:
  void frameAll();
  void present();

  const Options& options_;
  picture::Renderer& renderer_;
  const picture::View& view_;
  Pilot pilot_;
  Replay replay_;
};

} // namespace vv
