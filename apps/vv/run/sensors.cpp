#include "run/sensors.h"

#include "process/messages.h"
#include "process/signals.h"
#include "report/describe.h"
#include "report/measure_report.h"
#include "run/picture_files.h"

namespace vv {

void writeReadings(const Options& options, const std::string& commandLine,
                   const std::vector<picture::Measurement>& sensors) {
  if (sensors.empty() && !interrupted())
    throw Failure{exitProblems, "--measure: the world has no ORTSensor"};
  const bool json = options.measure.ends_with(".json");
  writeText(options.measure,
            json ? measurementsJson(sensors, commandLine) : measurementsCsv(sensors));
  if (options.quiet) return;
  for (const picture::Measurement& sensor : sensors) {
    say("vv: " + oneLine(measurementText(sensor)));
    for (const std::string& text :
         measurementWarnings(sensor, {options.render.error, uint32_t(options.render.samples),
                                      options.render.timeLimit > 0}))
      sayWarning(oneLine(text));
  }
}

} // namespace vv
