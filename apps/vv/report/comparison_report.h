// comparison_report.h: Says how two pictures differ (vv compare). [main thread]
#pragma once

#include <string>

#include "libpicture/compare/comparison.h"

namespace vv {

std::string comparisonText(const picture::Comparison& comparison);

} // namespace vv
