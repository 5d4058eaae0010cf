// kept_probes.h: Keeps probes in the world's file, as sensors, and makes probes of sensors. [the
// browser's thread, while the world can be used]
#pragma once

#include "edit/probes.h"

namespace vv {

// Returns whether a probe can be kept: a rectangle belongs to pictures of one view alone, and
// several points are a sensor of the file already.
inline bool canBeKept(const Probe& probe) { return !probe.isMean(); }

// Adds an ORTSensor at the end of the file that reads what a probe reads: the illuminance at its
// point, or the luminance that the viewer of this view sees there. Its description is the name of
// the probe. One step; selects the sensor.
// Throws xvrml::EditError if the file has that sensor, or the probe is not in the picture.
void keepInWorld(WorldEditor& editor, const Probe& probe, const EditView& view);

// Adds a probe for each ORTSensor of the file that has no probe yet, until there are `most` probes:
// one of several points reads their mean. The probe has the name of the sensor. Those with more
// than mostPoints points are left out. Throws xvrml::EditError if there is none to be added, or no
// room, and picture::SensorError for a sensor whose fields make no sense.
inline constexpr int mostPoints = 1000;
void showSensors(WorldEditor& editor, Probes& probes, size_t most = ~size_t(0));

} // namespace vv
