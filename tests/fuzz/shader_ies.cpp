// shader_ies.cpp: parses arbitrary text as a measured luminaire. Accepted text must give a finite
// intensity in every direction. libFuzzer calls this on one thread.
#include <cmath>
#include <string_view>

#include "../../plugins/shaders/ies.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ies::Photometry measured;
  int line = 0;
  if (ies::parse({reinterpret_cast<const char*>(data), size}, measured, line, 33)) return 0;
  for (double down = -90; down <= 180; down += 7.5)
    for (double around = -360; around <= 720; around += 22.5)
      if (const float candela = measured.intensity(down, around);
          !std::isfinite(candela) || candela < 0)
        __builtin_trap();
  return 0;
}
