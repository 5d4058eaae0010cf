// probes.h: Places in the world, and rectangles of the picture, whose light is read from still
// pictures, and surfaces whose light sensors read, with error bars; and what an edit has changed
// there. [the browser's thread]
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "edit/comparison.h"
#include "edit/region.h"
#include "libpicture/measure.h"

namespace vv {

struct Probe {
  enum class State : uint8_t { waiting, read, hidden, outside, otherView };
  struct Area { // a rectangle of the pictures of one view
    Region region;
    EditView view;
    RegionReading reading;
  };

  static constexpr size_t mostNameBytes = 200;

  int number = 0;
  std::string name;              // that a user has given it, or its sensor; "": none
  std::array<double, 3> point{}; // in the world, if there is no area
  std::string seen; // what it was put on: node, look, distance, place and normal; "" if nothing
  std::optional<Area> area;
  // Reads the light at the point, whatever the view is: the illuminance of the surface, or the
  // luminance that a sensor of the world sees; none: the probe reads the luminance in pictures.
  std::optional<picture::PlacedSensor> sensor;
  std::optional<MeanReading> points; // the readings of a sensor with several points
  State state = State::waiting;
  // The reading of its pixel, the mean of its area, or that of its sensor, or of the sensor's
  // points, as a luminance, also in lux.
  picture::PixelReading now;
  picture::PixelReading before; // the same, as it was kept
  bool hasBefore = false;

  // Tells whether its reading is the mean of several ones.
  bool isMean() const { return area || (sensor && sensor->columns * sensor->rows > 1); }
  // Returns these; null: there are none, or they have not been read.
  const MeanReading* several() const { return area ? &area->reading : points ? &*points : nullptr; }
};

// Returns how a probe is called: "1", or "1 Desk" with a name.
std::string titleOf(const Probe& probe);
// Return what a probe reads: "luminance" in "cd/m2", or "illuminance" in "lx".
const char* quantityOf(const Probe& probe);
const char* unitOf(const Probe& probe);
// Returns a luminance with its 95 % interval, or an illuminance: "412 cd/m2 +- 1.5 %  trusted".
std::string lightText(const picture::PixelReading& light, const char* unit);
// Returns what a probe says: "1 Desk  412 cd/m2 +- 1.5 %  trusted   B - A: -41 +- 8, significant".
std::string probeText(const Probe& probe, const std::optional<Difference>& change);

// The place of the picture where a pointer rests, from -1 to 1 each way, and what is seen there.
struct PointerReading {
  double x = 0, y = 0;
  std::optional<std::string> seen;            // as of a probe; none: it has not been looked for yet
  std::optional<picture::PixelReading> light; // none: there is no still picture with it yet
};

// Returns what a face says there, in lines. isReadable: the picture has error bars.
std::string pointerText(const PointerReading& pointer, bool isReadable);

class Probes {
 public:
  const std::vector<Probe>& all() const { return probes_; }
  // Tell whether there are probes that are read from pictures, and whether one waits for it.
  bool readPictures() const;
  bool isWaiting() const;
  void add(const std::array<double, 3>& point, std::string seen = {});
  // Adds a sensor. The place of one with several points is their middle.
  void addSensor(const picture::PlacedSensor& sensor, std::string seen = {});
  // Adds a rectangle of the pictures of this view.
  void add(const Region& region, const EditView& view);
  // Names the probe of this number, if there is one. Longer names are cut.
  void rename(int number, std::string_view name);
  void clear();
  // Reads all probes from a picture of this view, which has picture::readingChannels and only
  // unbiased samples. A probe behind something else, or where nothing is any more, is hidden. A
  // rectangle is read from pictures of its own view alone. [while the world can be used]
  void read(xvrml::Browser& browser, const picture::Picture& picture, const EditView& view);
  // Returns the sensors of the probes that have not been read yet, and takes their readings.
  std::vector<picture::PlacedSensor> waitingSensors() const;
  void take(const std::vector<picture::Measurement>& readings);
  // Notes that the world or the view has changed: all probes wait for the next picture. Sensors
  // wait only if the world has changed.
  void expire();
  void expireSensors();
  // Keeps the light of all probes that have been read, to compare what follows with it.
  void keep();
  // Lets the user's wish be known that the light is kept, and tells it once.
  void askToKeep() { wantsKeep_ = true; }
  bool takeKeep() { return std::exchange(wantsKeep_, false); }
  // Returns the changes of the probes, in their order; none where there is nothing to compare: the
  // probe was not read, or in a picture of another view. All are judged together.
  std::vector<std::optional<Difference>> differences() const;
  // Returns a table with a line for each probe.
  std::string csv() const;

 private:
  std::vector<Probe> probes_;
  int last_ = 0;         // the number of the last probe
  EditView view_, kept_; // views of the last picture, and of what was kept
  bool wantsKeep_ = false;
};

} // namespace vv
