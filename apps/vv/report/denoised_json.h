// denoised_json.h: Makes the part of --stats about denoised pictures. [main thread]
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "libpicture/renderer.h"

namespace vv {

// Returns image.denoised.doubt, or frames[].doubt of a sequence: numbers of pixels, and the share
// of the judged ones that is doubtful; null if none is judged.
inline nlohmann::ordered_json doubtJson(const picture::DoubtCounts& doubt) {
  using Json = nlohmann::ordered_json;
  return {{"pixels", doubt.pixels},
          {"judged", doubt.judged},
          {"doubtful", doubt.doubtful},
          {"share", doubt.judged ? Json(doubt.share()) : Json(nullptr)}};
}

// Returns image.denoised of the statistics.
inline nlohmann::ordered_json denoisedJson(const picture::RenderResult& result) {
  using Json = nlohmann::ordered_json;
  Json json = {
      {"by", result.picture.denoisedBy}, {"channels", Json::array({"rgba"})}, {"biased", true}};
  if (result.doubt) json["doubt"] = doubtJson(*result.doubt);
  return json;
}

} // namespace vv
