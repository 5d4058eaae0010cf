#include "measure_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "csv_field.h"
#include "describe.h"
#include "libpicture/transport.h"
#include "printable.h"

namespace vv {

namespace {

using picture::Measurement;
using Json = nlohmann::ordered_json;

const char* unitOf(const Measurement& m) { return picture::infoOf(m.sensor.quantity).unit; }
const char* quantityOf(const Measurement& m) { return picture::infoOf(m.sensor.quantity).name; }

// Returns how the light of lamps without extent is found behind glass, for the end of a warning.
std::string wayToReach(const Measurement& m) {
  if (m.sensor.quantity != picture::Quantity::illuminance) return "";
  if (!m.sensor.cells) return "; give the sensor a size and use --transport light";
  // The engine has refused to follow paths from lamps, and says why.
  const std::string reason = m.stats.transport.reason;
  if (reason.find("not at lamps") != std::string::npos) return "; " + reason;
  return "; --transport light follows it";
}

Json numberOrNull(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json sensorsOf(const std::vector<Measurement>& sensors) {
  Json out = Json::array();
  for (const Measurement& m : sensors) {
    const MeasurementSummary all(m);
    Json points = Json::array();
    for (size_t i = 0; i < m.value.size(); i++) {
      double p[3];
      m.sensor.pointAt(int(i) % m.sensor.columns, int(i) / m.sensor.columns, p);
      const bool made = m.samples[i] > 0;
      points.push_back({{"position", {p[0], p[1], p[2]}},
                        {"value", made ? numberOrNull(double(m.value[i])) : Json(nullptr)},
                        {"half_width", made ? numberOrNull(double(m.halfWidth[i])) : Json(nullptr)},
                        {"trusted", m.trusted[i] != 0},
                        {"samples", m.samples[i]}});
    }
    const double* d = m.sensor.direction;
    out.push_back({{"name", m.sensor.name},
                   {"quantity", quantityOf(m)},
                   {"unit", unitOf(m)},
                   {"direction", {d[0], d[1], d[2]}},
                   {"columns", m.sensor.columns},
                   {"rows", m.sensor.rows},
                   {"mean", numberOrNull(all.mean)},
                   {"mean_half_width", numberOrNull(all.halfWidth)},
                   {"minimum", numberOrNull(all.least)},
                   {"maximum", numberOrNull(all.most)},
                   {"uniformity", numberOrNull(all.uniformity())},
                   {"relative_half_width", numberOrNull(m.stats.error.halfWidth)},
                   {"unreached_lamps", m.stats.transport.unreachedLights},
                   {"interrupted", m.interrupted},
                   {"points", std::move(points)}});
    if (m.outdoors > 0) {
      out.back()["outdoors"] = m.outdoors;
      out.back()["daylight_factor_percent"] = numberOrNull(100 * all.mean / m.outdoors);
    }
  }
  return out;
}

// Says why a sensor has missed --error.
std::string whyMissed(const Measurement& m, const Promise& promise) {
  const uint32_t taken = *std::max_element(m.samples.begin(), m.samples.end());
  if (promise.timed && taken < promise.allowed)
    return "the time limit ended the measurement; --time-limit allows more time";
  const bool capped =
      picture::transportInfo(m.stats.transport.chosen).tracesLamps && !promise.timed;
  if (taken < promise.allowed)
    return capped ? "--error alone decides how many paths from lamps are taken; --spp N without "
                    "--error takes N of both"
                  : "a smaller --error takes more";
  return std::string("--spp allows more") +
         (capped ? ". Paths from lamps are limited as well (docs/error-bars.md): --spp N without "
                   "--error takes N of both"
                 : "");
}

bool hasDaylightFactors(const std::vector<Measurement>& sensors) {
  return std::any_of(sensors.begin(), sensors.end(),
                     [](const Measurement& m) { return m.outdoors > 0; });
}

} // namespace

MeasurementSummary::MeasurementSummary(const Measurement& m) {
  double squares = 0;
  for (size_t i = 0; i < m.value.size(); i++) {
    if (m.samples[i] == 0) continue;
    const auto value = double(m.value[i]), half = double(m.halfWidth[i]);
    least = points ? std::min(least, value) : value;
    most = points ? std::max(most, value) : value;
    mean += value;
    squares += half * half;
    trusted += m.trusted[i];
    points++;
  }
  if (points == 0) return;
  mean /= double(points);
  halfWidth = std::sqrt(squares) / double(points);
}

std::string shownReading(double value, int digits) {
  return value >= std::pow(10, digits) && value < 1e9 ? fmt::format("{:.0f}", value)
                                                      : fmt::format("{:.{}g}", value, digits);
}

std::string measurementsCsv(const std::vector<Measurement>& sensors) {
  std::string out = "sensor,quantity,unit,column,row,x [m],y [m],z [m],value [unit],"
                    "half-width of the 95 % interval [unit],trusted,samples";
  const bool hasFactors = hasDaylightFactors(sensors);
  out += hasFactors ? ",daylight factor [%]\r\n" : "\r\n";
  for (const Measurement& m : sensors)
    for (size_t i = 0; i < m.value.size(); i++) {
      if (m.samples[i] == 0) continue;
      const int column = int(i) % m.sensor.columns, row = int(i) / m.sensor.columns;
      double p[3];
      m.sensor.pointAt(column, row, p);
      out += fmt::format("{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.4g},{},{}",
                         csvField(m.sensor.name), quantityOf(m), unitOf(m), column, row, p[0], p[1],
                         p[2], m.value[i], m.halfWidth[i], int(m.trusted[i]), m.samples[i]);
      if (hasFactors)
        out += m.outdoors > 0 ? fmt::format(",{:.6g}", 100 * double(m.value[i]) / m.outdoors) : ",";
      out += "\r\n";
    }
  return out;
}

std::string measurementsJson(const std::vector<Measurement>& sensors,
                             const std::string& commandLine) {
  Json json;
  json["schema"] = 1;
  json["version"] = version();
  json["command"] = commandLine;
  json["interval"] = {{"level", .95}, {"method", "replicated nets, Student's t"}};
  json["units"] = {{"position", "m"}, {"illuminance", "lx"}, {"luminance", "cd/m2"}};
  json["sensors"] = sensorsOf(sensors);
  return printableJson(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

std::string sensorsJson(const std::vector<Measurement>& sensors) {
  return printableJson(sensorsOf(sensors).dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string measurementText(const Measurement& m) {
  const MeasurementSummary all(m);
  if (all.points == 0) return fmt::format("{}: no reading was finished", m.sensor.name);
  const bool isRated = m.sensor.quantity == picture::Quantity::glare;
  const std::string before = isRated ? "UGR " : "",
                    unit = isRated ? "" : std::string(" ") + unitOf(m);
  std::string out = fmt::format("{}: {}{}{} +- {}{} (95 %)", m.sensor.name, before,
                                shownReading(all.mean), unit, shownReading(all.halfWidth, 2), unit);
  if (all.points > 1)
    out += fmt::format(", mean of {} points from {} to {}{}, uniformity {:.3g}", all.points,
                       shownReading(all.least), shownReading(all.most), unit, all.uniformity());
  if (m.outdoors > 0) out += fmt::format(", daylight factor {:.3g} %", 100 * all.mean / m.outdoors);
  return out;
}

std::vector<std::string> measurementWarnings(const Measurement& m, const Promise& promise) {
  std::vector<std::string> out;
  const MeasurementSummary all(m);
  if (all.points == 0) return out;
  const auto add = [&](const std::string& text) { out.push_back(m.sensor.name + ": " + text); };
  if (promise.error > 0 && m.stats.error.halfWidth > 1.001 * promise.error) {
    const uint32_t taken = *std::max_element(m.samples.begin(), m.samples.end());
    add(fmt::format("--error promised {:.3g} %, reached {:.3g} % with {} samples; {}",
                    100 * promise.error, 100 * m.stats.error.halfWidth, taken,
                    whyMissed(m, promise)));
  }
  if (const size_t doubtful = all.points - all.trusted)
    add(fmt::format("the intervals of {} of {} points are not trusted: too few paths have found "
                    "the light there (docs/error-bars.md)",
                    doubtful, all.points));
  if (m.stats.transport.unreachedLights > 0)
    add(fmt::format("the light that {} lamps without extent send through glass or mirrors is "
                    "missing{}",
                    m.stats.transport.unreachedLights, wayToReach(m)));
  return out;
}

} // namespace vv
