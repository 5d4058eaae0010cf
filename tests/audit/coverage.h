// coverage.h: measures how often the error bars of pictures hold. Small scenes, one for each kind
// of difficulty, are rendered with many seeds. The pictures are compared with a long render of
// another seed and with each other. Uses only the public C API. Called by the numeric tests (few
// seeds) and by the program `audit` (many seeds). One context, on the calling thread.
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
  int samples;   // samples per pixel
  int reference; // samples per pixel of the reference render; 0: compare with `exact`
  double exact;
  double trusted;     // smallest accepted fraction of pixels with trusted intervals
  const char* reason; // why `trusted` is below 1; "" if it is not
  void (*draw)();     // draws the scene into the current context
};
const std::vector<Scenario>& scenarios(); // all scenes of the lists below
// Limits and rules of the library may be chosen from the results of these two lists.
const std::vector<Scenario>& firstScenes();
const std::vector<Scenario>& trainingScenes();
// Test set: no limit or rule of the library may be chosen from its results.
const std::vector<Scenario>& judgingScenes();
// Another test set, added after the limits and rules were set.
const std::vector<Scenario>& unseenScenes();

using Coverage = picture::Coverage;

// Judges one scene at several sample counts. The reference is rendered once.
class Judge {
 public:
  // Renders the reference in the current context. Sets samples, transport and seed; the other
  // quality settings stay. edge: width and height in pixels.
  Judge(const Scenario& scenario, int edge);
  // Renders with the seeds 1 to `seeds`.
  Coverage measure(int samples, int seeds);

 private:
  const Scenario& scenario_;
  const int edge_;
  picture::Reference reference_;
};
// Measures with the scenario's own number of samples.
Coverage measure(const Scenario& scenario, int seeds, int edge = 16);

} // namespace audit
