// squad.h: a smooth curve through rotations: spherical cubic interpolation (Shoemake 1987,
// "Quaternion calculus and fast animation"; ISO/IEC 19775-1 19.4.13). Pure function. [any thread]
#pragma once

#include <span>

#include "xvrml/types.h"

namespace xvrml {

// Returns the rotation between the values `left` and `left` + 1, at parameter t in [0,1].
Rotation squad(std::span<const Rotation> values, size_t left, double t);

} // namespace xvrml
