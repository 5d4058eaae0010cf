// picture_remarks.h: Says what a user should know about a finished picture: that it is biased,
// white or empty, that --error was missed and why; with -v, what it took. [main thread]
#pragma once

#include <string>

#include "libpicture/renderer.h"
#include "options/options.h"
#include "run/view_requests.h"

namespace vv {

class PictureRemarks {
 public:
  // The arguments must live as long.
  PictureRemarks(const Options& options, const xvrml::Browser& browser)
      : options_(options), browser_(browser) {}

  // Says, once in a run each, that pictures are biased, and that one is white for the most part.
  // falseColour: whether files for screens show false colours.
  void sayLook(const picture::RenderResult& result, bool falseColour);
  // With -v, says what the picture took. last: no other picture follows.
  void sayTimes(const PictureRequest& request, const picture::RenderResult& result,
                double writeSeconds, bool last) const;
  // Says why a picture shows nothing, and which option helps. In a sequence, the last picture alone
  // does, if none has shown anything. idle: no frame is in flight, so that a picture can be
  // rendered to find out what is in view.
  void sayHint(const PictureRequest& request, const picture::RenderResult& result, bool last,
               bool idle, picture::Renderer& renderer);
  // Warns if the picture has not reached --error.
  void warnOfError(const PictureRequest& request, const picture::RenderResult& result) const;
  // Says how much of a denoised picture is doubtful. In a sequence, only those are named that have
  // more doubt than --audit-denoise allows.
  void sayDoubt(const PictureRequest& request, const picture::RenderResult& result);
  // Tells whether a picture had more doubt than it allows.
  bool hasDoubt() const { return hasDoubt_; }

 private:
  const Options& options_;
  const xvrml::Browser& browser_;
  bool biasSaid_ = false, brightnessSaid_ = false;
  bool anythingShown_ = false; // a picture has shown something
  bool hasDoubt_ = false;
};

} // namespace vv
