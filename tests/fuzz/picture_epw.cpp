// picture_epw.cpp: reads arbitrary text as a weather file of EnergyPlus; the first line is the time
// that is asked for. An hour that is accepted must give finite numbers in their ranges. libFuzzer
// calls this on one thread.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "libpicture/sky/epw.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const size_t end = std::min(text.find('\n'), size);
  const picture::WeatherHour hour =
      picture::weatherHour(text.substr(std::min(end + 1, size)), text.substr(0, end));
  const picture::SunPosition sun = picture::sunPosition(hour.place, hour.moment);
  const bool isGood = std::abs(sun.altitude) <= 90.01 && std::isfinite(sun.azimuth) &&
                      hour.directNormal >= 0 && hour.directNormal <= 2000 &&
                      hour.diffuseHorizontal >= 0 && hour.diffuseHorizontal <= 2000 &&
                      std::abs(hour.dewPoint) <= 90;
  if (!isGood) __builtin_trap();
  return 0;
} catch (const std::invalid_argument&) { return 0; }
