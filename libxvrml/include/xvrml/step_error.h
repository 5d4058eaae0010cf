// step_error.h: the range of LoadOptions::stepError, in millimetres, beside 0. [any thread]
#pragma once

namespace xvrml {

inline constexpr double leastStepError = 1e-6; // below it there would be no end of triangles
inline constexpr double mostStepError = 1e18;

} // namespace xvrml
