#include "run/compare.h"

#include <fmt/format.h>

#include "libpicture/compare/comparison.h"
#include "libpicture/compare/drawing.h"
#include "process/messages.h"
#include "report/comparison_report.h"
#include "run/outputs.h"
#include "run/picture_files.h"

namespace vv {

namespace {

picture::Comparison compare(const Options& options) {
  const CompareOptions& given = options.compared;
  try {
    return picture::comparisonOf(
        {given.files[0], given.files[1]},
        {picture::readForComparison(given.files[0]), picture::readForComparison(given.files[1])},
        {given.samples, options.isGiven("--variance")});
  } catch (const picture::InputError& error) {
    throw Failure{exitInput, fmt::format("vv compare: {}", error.what())};
  } catch (const picture::CompareError& error) {
    throw Failure{exitInput, fmt::format("vv compare: {}", error.what())};
  }
}

} // namespace

int runCompare(const Options& options) {
  checkOutputs(options);
  const picture::Comparison comparison = compare(options);
  const auto& [a, b] = comparison.pictures;
  if (!options.outputs.empty()) {
    const std::vector<float> errors = picture::standardErrors(a, b);
    for (const Output& output : options.outputs)
      writeOutput(
          output, output.path,
          output.format->encode(picture::drawErrors(a, errors, output.format->appliesCurve)));
  }
  writeOut(options.json ? picture::comparisonJson(comparison) : comparisonText(comparison));
  return comparison.test.isSame ? exitDone : exitProblems;
}

} // namespace vv
