// luminance.h: the luminance of linear colours (ITU-R BT.709). [any thread]
#pragma once

namespace picture {

// Returns the luminance of red, green and blue: in cd/m2 for a radiance.
inline float luminanceOf(const float* rgb) {
  return .2126f * rgb[0] + .7152f * rgb[1] + .0722f * rgb[2];
}

} // namespace picture
