// main.cpp: `audit [SEEDS [EDGE [NAME]]]`: prints the observed coverage of the 95 % error bars, with its own interval. Exit code
// 1 where a scene's coverage is outside .93 to .97, its tiles are below .90, or too few of its pixels are trusted.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "audit/coverage.h"
#include "openrt/openrt.h"

namespace {

bool print(const audit::Scenario& s, const audit::Coverage& c) {
  std::string wrong;
  if (c.trustedShare() < s.trusted) wrong += " too few are trusted;";
  if (c.intervals() > 0 && (c.share() + c.shareInterval() < .93 || c.share() - c.shareInterval() > .97)) wrong += " coverage;";
  if (c.worstTiles < .90) wrong += " tiles;";
  if (c.exact - c.exactHeld > c.exact / 1000) wrong += " exact pixels are not;";
  std::printf("%-10s %5d %7.1f%% %6.1f%% %5llu  %.4f +- %.4f  %.3f  %.4f  %.5f  %.5f +- %.5f  %+.5f +- %.5f  %.3f %s\n",
              s.name.c_str(), s.samples, 100 * c.trustedShare(), 100 * double(c.exact) / double(c.pixels),
              static_cast<unsigned long long>(c.exact - c.exactHeld), c.share(), c.shareInterval(), c.worstTiles,
              double(c.held) / double(c.pixels), c.meanError, c.promised, c.promisedInterval, c.bias, c.biasInterval, c.cost,
              wrong.empty() ? s.reason : ("!" + wrong).c_str());
  std::fflush(stdout);
  return wrong.empty();
}

} // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 200, edge = argc > 2 ? std::atoi(argv[2]) : 16;
  if (seeds < 2 || edge < 1) {
    std::fprintf(stderr, "usage: audit [SEEDS [EDGE [NAME]]]\n");
    return 2;
  }
  std::printf("%-10s %5s %8s %7s %5s  %-16s  %-5s  %-6s  %-7s  %-18s  %-20s  %s\n", "scene", "spp", "trusted", "exact", "wrong",
              "coverage", "tiles", "of all", "off by", "said", "bias", "cost");
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
    good &= print(s, c);
  }
  return good ? 0 : 1;
}
