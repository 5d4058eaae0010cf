// live_turn.h: A scripted turn around what a world shows, in instants of 1/fps. The picture
// at an instant depends on its number alone, so pictures of different runs can be compared. Used by
// bench_live. [one thread, the browser's]
#pragma once

#include <memory>
#include <string>

#include "xvrml/browser.h"
#include "xvrml/camera.h"

// Where the turn begins: the world's first viewpoint, or a view of the whole world.
struct TurnStart {
  xvrml::CameraSettings camera;
  double distance = 10; // from the camera to the point that it turns around, straight ahead
};

// Measures the distance to what is seen at the middle of the first picture. aspect: width / height.
TurnStart findStart(const std::string& world, double aspect, int threads);

class Turn {
 public:
  // speed: radians per second at the start. The camera turns to and fro.
  Turn(const std::string& world, const TurnStart& start, double speed, double fps);

  // Lets the world's time pass up to an instant, in steps of 1/fps from 0. Instants must not
  // decrease.
  void advance(int instant);
  xvrml::CameraSettings camera(int instant) const;
  double time(int instant) const { return instant / fps_; } // in seconds
  xvrml::Browser& browser() { return browser_; }

 private:
  xvrml::Browser browser_;
  TurnStart start_;
  double speed_, fps_;
  int next_ = 0; // the first instant that the world has not reached
};
