// coverage.h: how often the error bars of pictures hold: small scenes of each kind of difficulty, rendered with many seeds and
// compared with a long render of another seed and with each other. Through the public C API only. For the numeric tests (few
// seeds) and the program `audit` (many). One context, on the calling thread.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "picture/coverage.h"

namespace audit {

struct Scenario {
  std::string name, text;
  int transport; // RT_TRANSPORT_*
  int samples;   // a pixel
  int reference; // samples of the long render; 0: `exact` instead
  double exact;
  double trusted;     // share of the pixels that the intervals must be trusted at, at least
  const char* reason; // why not more: ""
  void (*draw)();     // into the current context
};
const std::vector<Scenario>& scenarios();

using Coverage = picture::Coverage;

// Renders 16x16 pixels with seeds 1 .. seeds. Quality other than samples, transport and seed is left as it is.
Coverage measure(const Scenario& scenario, int seeds, int edge = 16);

} // namespace audit
