// step_error.h: the range of LoadOptions::stepError (xvrml/world.h) where it is not 0, in
// millimetres. Loading a STEP model throws LoadError for values outside.
#pragma once

namespace xvrml {

inline constexpr double leastStepError = 1e-6, mostStepError = 1e9;

} // namespace xvrml
