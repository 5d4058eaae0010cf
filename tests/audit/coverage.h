// coverage.h: how often the error bars of pictures hold: small scenes of each kind of difficulty, rendered with many seeds and
// compared with a long render of another seed and with each other. Through the public C API only. For the numeric tests (few
// seeds) and the program `audit` (many). One context, on the calling thread.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

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

struct Coverage {
  uint64_t pixels = 0, trusted = 0;  // over all seeds
  uint64_t exact = 0, exactHeld = 0; // of the trusted ones, those with no error at all: not counted in the share
  uint64_t held = 0, heldTrusted = 0;
  double halfWidth = 0;                                     // mean of the trusted ones
  double meanError = 0, promised = 0, promisedInterval = 0; // of whole pictures: what they were off by, and RTstats of one
  double bias = 0, biasInterval = 0;                        // of pictures' means against the reference, relative
  double worstTiles = 1;                                    // 5th percentile over the 8x8 tiles of their share, all seeds
  double cost = 0; // mean square error times samples over the sample variance: 1 for independent samples, less is better
  // Share of the trusted intervals that held, and the half-width of its own 95 % interval (E. B. Wilson's score).
  double share() const;
  double shareInterval() const;
  uint64_t intervals() const { return trusted - exact; }
  double trustedShare() const { return pixels ? double(trusted) / double(pixels) : 0; }
};

// Renders 16x16 pixels with seeds 1 .. seeds. Quality other than samples, transport and seed is left as it is.
Coverage measure(const Scenario& scenario, int seeds, int edge = 16);

} // namespace audit
