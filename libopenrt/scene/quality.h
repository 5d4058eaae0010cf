// quality.h: the one table of quality settings (openrt/frame.h). rtQuality checks values against
// it, rtGetQualityInfo and rtIsQualityAllowed publish it, and readers of recordings and messages
// check frames against it. [any thread]
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "edits_generated.h"
#include "openrt/frame.h"

namespace openrt {

struct QualitySetting {
  RTqualityInfo info;
  // Read and write the setting of a frame. Null for settings that are not part of a frame.
  double (*get)(const edit::FrameSettingsT& frame);
  void (*set)(edit::FrameSettingsT& frame, double value);
  // Whether sums of frames with different values may be added, or continued (frame_sums.cpp).
  bool mayDiffer = false;

  // Returns whether the value is in the range, and whole if the setting is. 0 may be allowed
  // outside of the range.
  bool allows(double value) const {
    if (!info.isReal && value != std::trunc(value)) return false;
    return (value >= info.minimum && value <= info.maximum) || (info.zeroIsAuto && value == 0);
  }
};

// Returns "depth: 0 to 10000 expected, not -1".
std::string qualityFault(const RTqualityInfo& info, double value);

// Returns a value as people write it: the name of a choice, or a number.
std::string qualityText(const RTqualityInfo& info, double value);

std::span<const QualitySetting> qualitySettings();
// Returns null for an unknown setting.
const QualitySetting* findQuality(RTenum quality);
// Returns the name of the first setting of a frame that is out of its range; null if all are valid.
const char* invalidQuality(const edit::FrameSettingsT& frame);
// Returns whether the frame's settings request error estimates.
bool wantsError(const edit::FrameSettingsT& frame);
// Returns whether a frame shows no light: its channels and settings need neither radiance nor
// errors.
bool showsNoLight(const edit::FrameSettingsT& frame);

inline constexpr uint32_t largestTile = 128; // largest tile edge in pixels

} // namespace openrt
