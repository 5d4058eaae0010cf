// probes.h: Places in the world whose light is read from still pictures, with error bars, and what
// an edit has changed there. [the browser's thread]
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "edit/edit_model.h"
#include "libpicture/pixel_reading.h"

namespace vv {

struct Probe {
  enum class State : uint8_t { waiting, read, hidden, outside };

  int number = 0;
  std::array<double, 3> point{}; // in the world
  State state = State::waiting;
  picture::PixelReading now, before; // before: as it was kept
  bool hasBefore = false;
};

// The change of a probe's light since it was kept.
struct Difference {
  double value = 0, halfWidth = 0; // cd/m2, with half of the 95 % interval
  bool isSignificant = false;      // among all probes (Holm), at 5 %
};

// Returns what a probe says: "1  412 cd/m2 +- 1.5 %  trusted   B - A: -41 +- 8, significant".
std::string probeText(const Probe& probe, const std::optional<Difference>& change);

class Probes {
 public:
  const std::vector<Probe>& all() const { return probes_; }
  // Tells whether a probe has not been read yet.
  bool isWaiting() const;
  void add(const std::array<double, 3>& point);
  void clear();
  // Reads all probes from a picture of this view, which has picture::readingChannels and only
  // unbiased samples. A probe behind something else, or where nothing is any more, is hidden.
  // [while the world can be used]
  void read(xvrml::Browser& browser, const picture::Picture& picture, const EditView& view);
  // Notes that the world or the view has changed: all probes wait for the next picture.
  void expire();
  // Keeps the light of all probes that have been read, to compare what follows with it.
  void keep();
  // Returns the changes of the probes, in their order; none where there is nothing to compare: the
  // probe was not read, or from another view. The two pictures are taken as independent (Welch);
  // where they share random numbers, the interval is too wide.
  std::vector<std::optional<Difference>> differences() const;
  // Returns a table with a line for each probe.
  std::string csv() const;

 private:
  std::vector<Probe> probes_;
  int last_ = 0; // the number of the last probe
  xvrml::CameraSettings camera_{}, kept_{};
};

} // namespace vv
