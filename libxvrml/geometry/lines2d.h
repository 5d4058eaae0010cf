// lines2d.h: an arc as a line, which also a Disk2D without width is.
#pragma once

#include "geometry/arc2d.h"

namespace xvrml {

Mesh arcLine(const Arc& arc, float radius);

} // namespace xvrml
