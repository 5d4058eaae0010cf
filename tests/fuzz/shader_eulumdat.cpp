// shader_eulumdat.cpp: parses arbitrary text as an EULUMDAT file. Accepted text must give a finite
// intensity in every direction. libFuzzer calls this on one thread.
#include <cmath>
#include <string_view>

#include "../../plugins/shaders/eulumdat.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  photometry::Photometry measured;
  int line = 0;
  eulumdat::looksLike(text);
  if (eulumdat::parse(text, measured, line)) return 0;
  for (double down = 0; down <= 180; down += 7.5)
    for (double around = -360; around <= 720; around += 22.5)
      if (const float candela = measured.intensity(down, around);
          !std::isfinite(candela) || candela < 0)
        __builtin_trap();
  return 0;
}
