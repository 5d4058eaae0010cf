// view_requests.h: Chooses the views that a run renders at one moment of the world: --viewpoint,
// --from. [main thread]
#pragma once

#include <vector>

#include "libpicture/renderer.h"
#include "options/names.h"
#include "options/options.h"

namespace vv {

// A picture to render: its camera, and the name that identifies it.
struct PictureRequest {
  picture::View view;
  PictureName name;
  bool turns = true;   // the picture is part of the run's films
  bool isStill = true; // the picture is written to files of one picture
};

// Returns the views of one moment, `view` with the viewpoint or side of each. first: it is the
// first moment; the turntable goes round from the first side of --from. Throws Failure if the world
// has no such viewpoint.
std::vector<PictureRequest> chooseRequests(const Options& options, const picture::View& view,
                                           const std::vector<xvrml::ViewpointInfo>& viewpoints,
                                           bool first = true);

} // namespace vv
