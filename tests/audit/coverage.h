// coverage.h: how often the error bars of pictures hold: small scenes of each kind of difficulty,
// rendered with many seeds and compared with a long render of another seed and with each other.
// Through the public C API only. For the numeric tests (few seeds) and the program `audit` (many).
// One context, on the calling thread.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "libpicture/coverage.h"

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
const std::vector<Scenario>& scenarios();      // all
const std::vector<Scenario>& firstScenes();    // may set limits
const std::vector<Scenario>& trainingScenes(); // may set limits
const std::vector<Scenario>& judgingScenes();  // may only judge

using Coverage = picture::Coverage;

// One scene, for pictures of several numbers of samples: what is true of it is made once.
class Judge {
 public:
  // In the current context, whose quality other than samples, transport and seed is left as it is.
  // edge: pixels.
  Judge(const Scenario& scenario, int edge);
  // Renders with seeds 1 .. seeds.
  Coverage measure(int samples, int seeds);

 private:
  const Scenario& scenario_;
  const int edge_;
  picture::Reference reference_;
};
Coverage measure(const Scenario& scenario, int seeds,
                 int edge = 16); // with the scene's own number of samples

} // namespace audit
