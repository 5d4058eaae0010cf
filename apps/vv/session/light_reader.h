// light_reader.h: Reads the light for the faces of the editor, between the frames of a session: the
// probes, from still pictures and by sensors, what is seen where a pointer rests, and the picture
// that is kept as A with what has changed since. All of it is of viewer 0. [the browser's thread,
// while the world can be used]
#pragma once

#include <cstdint>
#include <map>
#include <optional>
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
  // The pointer of a face, which has a number, rests at a place of the picture, or rests no more.
  // The light there is read from still pictures as long as it rests. A picture that was made
  // without error bars stays: only the next one has them.
  void point(uint64_t face, double x, double y);
  void leave(uint64_t face) { pointers_.erase(face); }
  // Returns what is seen there; null: the pointer does not rest.
  const PointerReading* pointerOf(uint64_t face) const;
  // Reads what is due, a few times a second. seconds: time of any clock. Returns whether something
  // else is shown now.
  bool update(Session& session, double seconds);
  // Returns, once, what is to be said to the user.
  std::string takeMessage();
  // Forgets the world, because another takes its place.
  void clear();

 private:
  void readStill(Session& session, const EditView& view, double seconds);
  void lookAtPointers(Session& session, const EditView& view);
  bool isPointerWaiting() const;
  void readSensors(Session& session, double seconds);

  Probes probes_;
  Comparison comparison_;
  std::map<uint64_t, PointerReading> pointers_; // by face
  double stillRead_ = 0;                        // when
  uint64_t finishedRead_ = 0;                   // the number of the finished frame that was read
  double nextSensors_ = 0;                      // when sensors are read again, after a failure
  bool hasChanged_ = false;                     // something else is shown since the last update
  std::string message_;
};

// Returns where viewer 0 of a session stands.
EditView viewOf(Session& session);

} // namespace vv
