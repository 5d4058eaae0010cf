// light_reader.h: Reads the light for a face of the editor, between the frames of a session: the
// probes, from still pictures and by sensors, and the picture that is kept as A with what has
// changed since. All of it is of viewer 0. [the browser's thread, while the world can be used]
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "edit/comparison.h"
#include "edit/probes.h"
#include "session/session.h"

namespace vv {

class LightReader {
 public:
  Probes& probes() { return probes_; }
  Comparison& comparison() { return comparison_; }

  // Put a probe of luminance, or of illuminance, at the surface that is seen at a place of the
  // picture. Throw xvrml::EditError.
  void addProbe(WorldEditor& editor, const EditView& view, double x, double y);
  void addSensor(WorldEditor& editor, const EditView& view, double x, double y);
  // Keeps the light of the probes, and the next still picture, as A. view: that of viewer 0.
  void keep(WorldEditor& editor, const EditView& view);
  // Reads what is due, a few times a second. seconds: time of any clock. Returns whether something
  // else is shown now.
  bool update(Session& session, double seconds);
  // Returns, once, what is to be said to the user.
  std::string takeMessage();
  // Forgets the world, because another takes its place.
  void clear();

 private:
  void readStill(Session& session, const EditView& view, double seconds);
  void readSensors(Session& session, double seconds);

  Probes probes_;
  Comparison comparison_;
  double stillRead_ = 0;      // when
  uint64_t finishedRead_ = 0; // the number of the finished frame that was read
  double nextSensors_ = 0;    // when sensors are read again, after a failure
  bool hasChanged_ = false;   // something else is shown since the last update
  std::string message_;
};

// Returns where viewer 0 of a session stands.
EditView viewOf(Session& session);

} // namespace vv
