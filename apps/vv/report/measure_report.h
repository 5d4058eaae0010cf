// measure_report.h: the reports of --measure: readings of sensors as CSV and JSON, and lines for
// people. Pure functions.
#pragma once

#include <string>
#include <vector>

#include "libpicture/measure.h"

namespace vv {

// Statistics over the finished points of a sensor.
struct MeasurementSummary {
  size_t points = 0, trusted = 0;
  double mean = 0, halfWidth = 0; // the points are independent, so squares of half-widths add up
  double least = 0, most = 0;

  explicit MeasurementSummary(const picture::Measurement& m);
  // Uniformity of illuminance: the least over the mean (EN 12665).
  double uniformity() const { return mean > 0 ? least / mean : 0; }
};

// Returns a reading for people: so many digits, or all before the point.
std::string shownReading(double value, int digits = 4);

// Returns the readings as CSV (RFC 4180): one line per point, after a line of names with units.
std::string measurementsCsv(const std::vector<picture::Measurement>& sensors);
// Returns the readings as JSON, schema 1.
std::string measurementsJson(const std::vector<picture::Measurement>& sensors,
                             const std::string& commandLine);
// Returns the readings as a JSON array without line feeds: the member "sensors" of the above.
std::string sensorsJson(const std::vector<picture::Measurement>& sensors);
// Describes one sensor in a line: mean with its interval, range, uniformity.
std::string measurementText(const picture::Measurement& sensor);
// The user asked for a target error (0: none), with at most so many samples. A time limit may end
// the measurement before.
struct Promise {
  double error = 0;
  uint32_t allowed = 0;
  bool timed = false;
};
// Returns what a reader of the readings must know, a sentence each: a missed --error, light that is
// missing, readings that are not trusted.
std::vector<std::string> measurementWarnings(const picture::Measurement& sensor,
                                             const Promise& promise);

} // namespace vv
