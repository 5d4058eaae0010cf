// motions.h: finds out how the placed geometries of a scene have moved since the frame before
// in the same view (render/motion.h): the matrices and vertices of now beside those that the
// history has kept. It costs what has moved if only dynamic instances and objects have changed,
// else one pass over everything placed. Called by the local backend between frames, on the
// application thread.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/survey.h"
#include "render/motion.h"
#include "scene/flatten.h"
#include "scene/view_history.h"

namespace openrt {

struct MotionInput {
  const Scene& scene;
  const ViewHistory& history;
  const Flattened& flat; // with paths, unless there was no frame before
  const Survey& survey;
  const Accel& accel;
};

// Returns null if nothing has moved and nothing is new. clusters: those that may have moved, with
// all clusters below them, in ascending order; null: anything may have moved.
std::shared_ptr<const Motions> makeMotions(const MotionInput& input,
                                           const std::vector<uint32_t>* clusters);

} // namespace openrt
