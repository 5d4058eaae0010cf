// main.cpp: `audit [SEEDS [EDGE [NAME]]]`: prints the observed coverage of the 95 % error bars, with its own interval.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "audit/coverage.h"
#include "openrt/openrt.h"

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 200, edge = argc > 2 ? std::atoi(argv[2]) : 16;
  if (seeds < 1 || edge < 1) {
    std::fprintf(stderr, "usage: audit [SEEDS [EDGE [NAME]]]\n");
    return 2;
  }
  std::printf("%-11s %5s %9s %9s %6s  %-17s %-9s %-9s  %s\n", "scene", "spp", "trusted", "exact", "wrong", "coverage of those",
              "of all", "off by", "said");
  bool good = true;
  for (const audit::Scenario& s : audit::scenarios()) {
    if (argc > 3 && s.name != argv[3]) continue;
    RTcontext context = rtNewContext(nullptr);
    const audit::Coverage c = audit::measure(s, seeds, edge);
    if (const RTenum error = rtGetError(); error != RT_NO_ERROR) {
      std::fprintf(stderr, "%s: %s\n", s.name.c_str(), rtGetErrorMessage());
      return 1;
    }
    rtDeleteContext(context);
    const bool holds = c.intervals() < 1000 || (c.share() >= .93 && c.share() <= .97);
    good &= holds;
    std::printf("%-11s %5d %8.1f%% %8.1f%% %6llu  %.4f +- %.4f%s %.4f    %.5f    %.5f +- %.5f\n", s.name.c_str(), s.samples,
                100 * c.trustedShare(), 100 * double(c.exact) / double(c.pixels),
                static_cast<unsigned long long>(c.exact - c.exactHeld), c.share(), c.shareInterval(), holds ? " " : "!",
                double(c.held) / double(c.pixels), c.meanError, c.promised, c.promisedInterval);
    std::fflush(stdout);
  }
  return good ? 0 : 1;
}
