#include "run/sensors.h"

#include <filesystem>

#include "process/messages.h"
#include "process/signals.h"
#include "report/describe.h"
#include "report/measure_page.h"
#include "run/picture_files.h"

namespace vv {

void writeReadings(const Options& options, const std::string& commandLine,
                   const std::vector<picture::Measurement>& sensors,
                   std::vector<picture::Luminaire> luminaires) {
  if (sensors.empty() && !interrupted())
    throw Failure{exitProblems, "--measure: the world has no ORTSensor"};
  const Promise promise{options.render.error, uint32_t(options.render.samples),
                        options.render.timeLimit > 0};
  const auto text = [&] {
    if (options.measure.ends_with(".json")) return measurementsJson(sensors, commandLine);
    if (!options.measure.ends_with(".html")) return measurementsCsv(sensors);
    return measurementsPage(sensors,
                            {std::filesystem::path(options.input).filename().string(), commandLine,
                             options.skyText, promise, std::move(luminaires)});
  };
  writeText(options.measure, text());
  if (options.quiet) return;
  for (const picture::Measurement& sensor : sensors) {
    say("vv: " + oneLine(measurementText(sensor)));
    for (const std::string& warning : measurementWarnings(sensor, promise))
      sayWarning(oneLine(warning));
  }
}

} // namespace vv
