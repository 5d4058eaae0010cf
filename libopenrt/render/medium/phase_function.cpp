#include "render/medium/phase_function.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/orthonormal_basis.h"

namespace openrt {

double phaseFunction(double g, double cosine) {
  const double square = 1 + g * g - 2 * g * cosine; // (1 - |g|)^2 at least
  return (1 - g * g) / (4 * std::numbers::pi * square * std::sqrt(square));
}

// Inverts the distribution function of the cosine. Near g = 0, where that formula divides by g, its
// expansion to the second order in g is used.
double samplePhaseCosine(double g, double u) {
  const double s = 2 * u - 1;
  if (std::fabs(g) < 1e-4) return s + 1.5 * g * (1 - s * s) - 2 * g * g * s * (1 - s * s);
  const double ratio = (1 - g * g) / (1 + g * s);
  return std::clamp((1 + g * g - ratio * ratio) / (2 * g), -1.0, 1.0);
}

namespace {

// The pdf of sampling is the phase function itself.
void evaluate(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
              const float* const direction[3], float* const value[3], float* density) {
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t h = hit[i];
    const double cosine = dot(Vec3d(load(hits->direction, h)), Vec3d(load(direction, i)));
    density[i] = float(phaseFunction(double(lobe->data[0][h]), cosine));
    for (int k = 0; k < 3; k++) value[k][i] = density[i];
  }
}

void sample(const RtsLobe* lobe, const RtsHits* hits, uint32_t n, const uint32_t* hit,
            const float* const square[2], float* const direction[3], float* const quotient[3],
            float* density) {
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t h = hit[i];
    const double g = double(lobe->data[0][h]), cosine = samplePhaseCosine(g, double(square[0][i])),
                 sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)),
                 turn = 2 * std::numbers::pi * double(square[1][i]);
    const Vec3f before = load(hits->direction, h);
    Vec3f s, t;
    basisOf(before, s, t);
    store(Vec3f(normalize(sine * std::cos(turn) * Vec3d(s) + sine * std::sin(turn) * Vec3d(t) +
                          cosine * Vec3d(before))),
          direction, i);
    density[i] = float(phaseFunction(g, cosine));
    for (int k = 0; k < 3; k++) quotient[k][i] = 1;
  }
}

} // namespace

const RtsLobeFunctions phaseLobe = {sizeof(RtsLobeFunctions), 1, evaluate, sample};

} // namespace openrt
