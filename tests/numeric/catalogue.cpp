// catalogue.cpp: a listener of the test program. tools/accuracy.py makes the tables of
// docs/accuracy.md from its lines, which begin with "accuracy" and have tabs between their fields.
#include "numeric/catalogue.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

namespace numeric {
namespace {

struct Current {
  double got = NAN, expected = NAN, tolerance = NAN, ratio = -1;
  uint64_t comparisons = 0, rays = 0;
  std::chrono::steady_clock::time_point began;
};
Current current;

// Ids of tests whose names do not begin with the id. They come from part A of the design's
// accuracy.md; V stands for the lighting of VRML97.
const std::map<std::string, const char*> ids = {
    {"Watertight.NoRandomRayLeavesAClosedBall", "N3"},
    {"Watertight.NoRayAimedAtVerticesLeaves", "N4"},
    {"Rays.HostileRaysHitNothingAndAreCounted", "N8"},
    {"Rays.MatricesThatAreNotFiniteAreRefused", "N8"},
    {"Rays.SingularInstancesDrawNothing", "N12"},
    {"Rays.SingularMatricesInsideObjectsDrawNothing", "N12"},
    {"Rays.FarAwayThingsNeitherShowNorHarm", "N10"},
    {"Rays.OneThingFarAwayLeavesTheOthersAlone", "N10"},
    {"Rays.DegenerateTrianglesAreDropped", "N7"},
    {"Rays.CamerasInOddPlacesMakePictures", "N21"},
    {"Placement.AThousandNestedTurns", "N12"},
    {"Placement.NormalsUnderNestedScalesAndMirrors", "N12"},
    {"Invariance.TurnedAndMirrored", "G10"},
    {"Lobes.AStackOfPanesHasItsClosedForm", "D15"},
    {"Lobes.GlassIsInvisibleInAFurnace", "G1"},
    {"Lobes.G2AndG4AClosedFurnaceByPathTracing", "G2, G4"},
    {"Lobes.MetalReflectsByItsComplexIndex", "A1 conductors"},
    {"Lamps.FormFactorOfParallelSquares", "A1 form factors"},
    {"Lamps.FormFactorOfSquaresWithACommonEdge", "A1 form factors"},
    {"Lamps.FormFactorOfDiscs", "A1 form factors"},
    {"ErrorBars.OneOrTwoThreadsGiveTheSameBytes", "N22"},
    {"LightTracing.ThePictureDoesNotDependOnThreads", "N22"},
    {"ErrorBars.StoppingDoesNotBiasWhatIsRare", "A4"},
    {"ErrorBars.ATargetIsReachedWithoutBias", "A4"},
    {"Room.OfTheIntervals95PercentHold", "A4"},
    {"Cie171.Case52PointLightSource", "CIE 171 5.2"},
    {"Cie171.Case53AreaLightSource", "CIE 171 5.3"},
    {"Cie171.Case54LuminousFluxIsConserved", "CIE 171 5.4"},
    {"Cie171.Case55DirectionalTransmittanceOfClearGlass", "CIE 171 5.5"},
    {"Cie171.Case56ReflectionByADiffuseSurface", "CIE 171 5.6"},
    {"Cie171.Case57DiffuseReflectionWithAnObstruction", "CIE 171 5.7"},
    {"Cie171.Case58InternallyReflectedComponent", "CIE 171 5.8"},
};

// Returns the id: D1 for "Lobes.D1ASlab...". "Offsets/Watertight.Name/0" is looked up as
// "Watertight.Name".
std::string idOf(const testing::TestInfo& test) {
  std::string suite = test.test_suite_name(), name = test.name();
  if (const size_t slash = suite.rfind('/'); slash != suite.npos) suite.erase(0, slash + 1);
  name = name.substr(0, name.find('/'));
  if (const auto known = ids.find(suite + "." + name); known != ids.end()) return known->second;
  size_t end = 1;
  while (end < name.size() && name[end] >= '0' && name[end] <= '9') end++;
  const bool letter = std::string("RGDNV").find(name[0]) != std::string::npos;
  return letter && end > 1 ? name.substr(0, end) : "";
}

class Lines : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override {
    current = {.began = std::chrono::steady_clock::now()};
  }
  void OnTestEnd(const testing::TestInfo& test) override {
    const std::string id = idOf(test);
    if (id.empty()) return;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - current.began).count();
    std::printf("accuracy\t%s\t%s.%s\t%.9g\t%.9g\t%.3g\t%llu\t%s\t%.3f\t%llu\n", id.c_str(),
                test.test_suite_name(), test.name(), current.expected, current.got,
                current.tolerance, static_cast<unsigned long long>(current.comparisons),
                test.result()->Passed() ? "pass" : "FAIL", seconds,
                static_cast<unsigned long long>(current.rays));
  }
};

const bool listening = [] {
  testing::UnitTest::GetInstance()->listeners().Append(new Lines);
  return true;
}();

} // namespace

void noteComparison(double got, double expected, double tolerance) {
  const double off = std::fabs(got - expected), ratio = tolerance > 0 ? off / tolerance
                                                        : off > 0     ? INFINITY
                                                                      : 0;
  current.comparisons++;
  if (ratio <= current.ratio) return;
  current.got = got;
  current.expected = expected;
  current.tolerance = tolerance;
  current.ratio = ratio;
}

void noteRays(uint64_t rays) { current.rays += rays; }

} // namespace numeric
