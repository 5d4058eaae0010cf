// main.cpp: `audit [SEEDS [EDGE [NAME]]]` checks whether the error bars hold. For each scene, with
// 64 and with 512 samples, it prints:
// * the fraction of pixels that are trusted;
// * the coverage of their 95 % intervals, with its own interval, and its 5th percentile over tiles;
// * how many pictures were off by errorMean +- errorMeanInterval.
//
// It then lists which promises hold. The exit code is 1 if one does not.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "audit/coverage.h"
#include "openrt/openrt.h"

namespace {

struct Promise { // a promise, and in how many scenes it held
  const char* promise;
  int held = 0, all = 0;
  std::string not_;
  void add(bool good, const std::string& name) {
    all++;
    held += good;
    if (!good) not_ += (not_.empty() ? "" : ", ") + name;
  }
};
Promise coverage{"of the trusted intervals 93 to 97 % hold", 0, 0, {}},
    tiles{"in 95 % of the tiles at least 90 % do", 0, 0, {}},
    exact{"of the pixels called exact one in a thousand is not", 0, 0, {}},
    whole{"the picture is off by errorMean +- errorMeanInterval in 90 % of the pictures", 0, 0, {}},
    safe{"it is off by at most their sum in 95 % of the pictures", 0, 0, {}};

// Returns whether a fraction of `count` is at least p, allowing three standard errors of noise.
bool atLeast(double share, double p, double count) {
  return share + 3 * std::sqrt(p * (1 - p) / count) >= p;
}

void print(const audit::Scenario& s, const char* use, int samples, const audit::Coverage& c) {
  std::string wrong;
  const std::string name = s.name + " " + std::to_string(samples);
  const auto judge = [&](Promise& promise, bool good, const char* word) {
    promise.add(good, name);
    if (!good) wrong += std::string(wrong.empty() ? "!" : ", ") + word;
  };
  const double shots = double(c.shots);
  if (c.intervals() > 0) {
    judge(coverage, c.share() + c.shareInterval() >= .93 && c.share() - c.shareInterval() <= .97,
          "coverage");
    judge(tiles, c.worstTiles >= .90, "tiles");
  }
  judge(exact, double(c.exact - c.exactHeld) <= double(c.exact) / 1000, "exact");
  judge(whole, atLeast(c.promiseShare(), .90, shots), "mean error");
  judge(safe, atLeast(double(c.promiseHeld + c.promiseBelow) / shots, .95, shots), "unsafe");
  std::printf("%-10s %-8s %5d %8.1f%% %6.1f%% %5llu  %.4f +- %.4f  %.3f  %.4f  %.5f  %.5f +- %.5f  "
              "%.3f  %+.5f +- %.5f  %.3f %s\n",
              s.name.c_str(), use, samples, 100 - 100 * c.trustedShare(),
              100 * double(c.exact) / double(c.pixels),
              static_cast<unsigned long long>(c.exact - c.exactHeld), c.share(), c.shareInterval(),
              c.worstTiles, double(c.held) / double(c.pixels), c.meanError, c.promised,
              c.promisedInterval, c.promiseShare(), c.bias, c.biasInterval, c.cost, wrong.c_str());
  std::fflush(stdout);
}

bool run(const std::vector<audit::Scenario>& scenes, const char* use, int seeds, int edge,
         const std::string& only) {
  for (const audit::Scenario& s : scenes) {
    if (!only.empty() && s.name != only && only != use) continue;
    RTcontext context = rtNewContext(nullptr);
    audit::Judge judge(s, edge);
    for (int samples : {64, 512}) print(s, use, samples, judge.measure(samples, seeds));
    if (const RTenum error = rtGetError(); error != RT_NO_ERROR) {
      std::fprintf(stderr, "%s: %s\n", s.name.c_str(), rtGetErrorMessage());
      return false;
    }
    rtDeleteContext(context);
  }
  return true;
}

} // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 60, edge = argc > 2 ? std::atoi(argv[2]) : 16;
  const std::string only = argc > 3 ? argv[3] : "";
  if (seeds < 2 || edge < 1) {
    std::fprintf(stderr, "usage: audit [SEEDS [EDGE [NAME|training|judging|unseen]]]\n");
    return 2;
  }
  std::printf("%-10s %-8s %5s %9s %7s %5s  %-16s  %-5s  %-6s  %-7s  %-18s  %-5s  %-20s  %s\n",
              "scene", "use", "spp", "untrusted", "exact", "wrong", "coverage", "tiles", "of all",
              "off by", "said", "in it", "bias", "cost");
  if (!run(audit::firstScenes(), "training", seeds, edge, only) ||
      !run(audit::trainingScenes(), "training", seeds, edge, only) ||
      !run(audit::judgingScenes(), "judging", seeds, edge, only) ||
      !run(audit::unseenScenes(), "unseen", seeds, edge, only))
    return 1;
  bool good = true;
  for (const Promise& h : {coverage, tiles, exact, whole, safe}) {
    std::printf("# %d of %d: %s%s%s\n", h.held, h.all, h.promise, h.not_.empty() ? "" : "; not at ",
                h.not_.c_str());
    good &= h.held == h.all;
  }
  return good ? 0 : 1;
}
