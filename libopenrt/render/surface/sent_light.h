// sent_light.h: the light that the hits of a batch send back along their rays, as arrays by hit.
// [render]
#pragma once

namespace openrt {

struct SentLight {
  float* radiance[3];
  float* coated[3] = {}; // the part that coats reflect (RtsLobe.coat); null: nobody asks for it
};

} // namespace openrt
