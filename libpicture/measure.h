// measure.h: photometric readings of the ORTSensors of a world: where their points are, and what
// they read. Renderer::measure() makes the readings; the sensors are placed by pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "libpicture/renderer.h"

namespace picture {

// A sensor of the world has fields that make no sense; the message names the sensor and the field.
struct SensorError : RenderError {
  using RenderError::RenderError;
};

// The quantities that sensors measure. The numbers are kept in files of Python.
enum class Quantity : uint8_t { illuminance, luminance, glare };
struct QuantityInfo {
  const char *word, *name, *unit; // in the field `quantity`; in reports
};
inline constexpr QuantityInfo quantityTable[] = {
    {"ILLUMINANCE", "illuminance", "lx"}, {"LUMINANCE", "luminance", "cd/m2"}, {"UGR", "UGR", ""}};
inline const QuantityInfo& infoOf(Quantity quantity) { return quantityTable[size_t(quantity)]; }

// A sensor, placed in the world: a camera whose rays start at the points, row by row.
struct PlacedSensor {
  std::string name; // DEF name, else description, else "ORTSensor"
  Quantity quantity = Quantity::illuminance;
  int columns = 1, rows = 1;
  bool cells = false; // the grid has a size, so that each point has a cell around it
  // World coordinates: the first point, the steps to the next column and to the next row, and the
  // unit normal of the plane (or the direction of view).
  double first[3], column[3], row[3], direction[3];

  void pointAt(int column, int row, double out[3]) const;
  // Writes the matrix (local to world, column-major) of the orthographic camera of height `rows`
  // whose rays start at the points, moved by `lift` along the direction.
  void camera(double lift, double out[16]) const;
};

// Places a sensor. Throws SensorError if its fields are out of range or its place is flat.
PlacedSensor placeSensor(const xvrml::SensorInfo& info);
// Returns a sensor without a name that reads the illuminance at a point of a surface, on the side
// that a ray along `seen` meets. normal: a unit vector, of either side.
PlacedSensor sensorAt(const double point[3], const double normal[3], const double seen[3]);

// The readings of one sensor, by point, row by row.
struct Measurement {
  PlacedSensor sensor;
  std::vector<float> value;     // in the unit of the quantity
  std::vector<float> halfWidth; // half of the 95 % interval; infinite if nothing is known
  std::vector<uint8_t> trusted; // 1 where the interval can be trusted (docs/error-bars.md)
  std::vector<uint32_t> samples;
  // Illuminance in lux of a horizontal plane in the open, under an overcast sky of the settings; an
  // illuminance over it is a daylight factor. 0: there is no such sky, or another quantity.
  double outdoors = 0;
  bool interrupted = false; // points that were not finished have 0 samples
  RTstats stats;            // statistics of the sensor's frame
};

} // namespace picture
