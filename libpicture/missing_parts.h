// missing_parts.h: The Inlines of a world that are empty because their files cannot be read: parts
// that a picture of a board lacks. [the thread that owns the world]
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/world.h"

namespace picture {

struct MissingPart {
  std::string path; // DEF names from the root, "Board/R12"; a node without one is left out
  std::string url;  // the first one of the Inline
  xvrml::SourcePosition where;
  // The box that it fills, in the coordinates of the Inline; none if its size is not known.
  std::optional<xvrml::Vec3f> size, center;
};

// Returns the size in millimetres that the name of a KiCad model states: of
// SOIC-8_3.9x4.9mm_P1.27mm.wrl, R_0805_2012Metric.wrl or LED_D5.0mm.wrl. A height that it does not
// state is half of the shorter side. None if the name states no size.
std::optional<xvrml::Vec3f> sizeInName(std::string_view file);

// Returns the parts in the order of a walk over the world. The size is the bboxSize of the Inline,
// or that in the name, which is in units of a tenth of an inch like all of KiCad's models.
std::vector<MissingPart> missingParts(const xvrml::World& world);

// Puts a clear grey box in the place of each missing part with a known size. Returns how many boxes
// there are. Call it before anything has been made of the world.
size_t addPlaceholders(xvrml::World& world);

} // namespace picture
