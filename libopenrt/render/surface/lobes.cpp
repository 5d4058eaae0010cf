// lobes.cpp: built-in lobes. Microfacets: B. Walter et al., "Microfacet Models for Refraction
// through Rough Surfaces", EGSR 2007 (the GGX distribution). Height-correlated shadowing: E. Heitz,
// "Understanding the Masking-Shadowing Function", JCGT 3(2), 2014. Visible normals are sampled as
// in J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023. Everything
// is computed in double, because a lobe of width 1e-4 has pdfs of 1e8 and in float loses its digits
// near its axis.
#include "render/surface/lobes.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "render/orthonormal_basis.h"
#include "render/surface/lambert.h"
#include "render/surface/scatter.h"
#include "render/wave/batch.h"
#include "shading/running.h"

namespace openrt {
namespace {

Vec3d unit(const Vec3d& a) {
  const double l = dot(a, a);
  return (l > 0 ? 1 / std::sqrt(l) : 0.0) * a;
}

// Local frame of a lobe; its normal is the z axis.
class Frame {
 public:
  Frame(const RtsLobe& lobe, uint32_t hit) {
    const Vec3f n = load(lobe.normal, hit);
    Vec3f s, t;
    basisOf(n, s, t);
    s_ = Vec3d(s);
    t_ = Vec3d(t);
    n_ = Vec3d(n);
  }
  Vec3d toLocal(const Vec3f& v) const {
    const Vec3d d(v);
    return {dot(d, s_), dot(d, t_), dot(d, n_)};
  }
  Vec3f toWorld(const Vec3d& v) const { return Vec3f(v.x * s_ + v.y * t_ + v.z * n_); }

 private:
  Vec3d s_, t_, n_;
};

// Value (of every colour) and pdf of a lobe for one direction.
struct LobeValue {
  float value = 0, pdf = 0;
};
// A direction sampled from a lobe, with value / pdf. pdf 0: no direction was sampled.
struct SampledDirection {
  Vec3f direction;
  float quotient = 0, pdf = 0;
};

// Microfacets
// -------------------------------------------------------------------------------------------------

class Facets {
 public:
  explicit Facets(double alpha) : a_(alpha > 1e-4 ? std::min(alpha, 1.0) : 1e-4) {}
  // Returns the distribution of facet normals per area and solid angle at h.
  double distribution(const Vec3d& h) const {
    const double t = (h.x * h.x + h.y * h.y) / (a_ * a_) + h.z * h.z;
    return h.z > 0 ? 1 / (M_PI * a_ * a_ * t * t) : 0;
  }
  // Smith's Lambda: a fraction 1 / (1 + Lambda) of the facets that face v is visible from v.
  double lambda(const Vec3d& v) const {
    const double slope2 = a_ * a_ * (v.x * v.x + v.y * v.y) / (v.z * v.z);
    return v.z != 0 ? (std::sqrt(1 + slope2) - 1) / 2 : 1e30;
  }
  double masking(const Vec3d& v) const { return 1 / (1 + lambda(v)); }
  double shadowing(const Vec3d& v, const Vec3d& w) const { return 1 / (1 + lambda(v) + lambda(w)); }
  // Samples a facet normal among those visible from v.
  Vec3d visible(const Vec3d& v, double u1, double u2) const {
    const Vec3d stretched = unit({a_ * v.x, a_ * v.y, v.z});
    const double phi = 2 * M_PI * u1, z = (1 - u2) * (1 + stretched.z) - stretched.z;
    const double s = std::sqrt(std::max(0.0, 1 - z * z));
    const Vec3d h = Vec3d{s * std::cos(phi), s * std::sin(phi), z} + stretched;
    return unit({a_ * h.x, a_ * h.y, std::max(h.z, 0.0)});
  }
  // Returns the pdf of visible(), by the solid angle of normals.
  double visiblePdf(const Vec3d& v, const Vec3d& h) const {
    return masking(v) * distribution(h) * std::max(0.0, dot(v, h)) / v.z;
  }

 private:
  double a_;
};

double fresnelAt(double cosine, double eta) {
  double behind;
  return fresnel(std::min(1.0, std::max(0.0, cosine)), eta, behind);
}

// A direction sampled in the frame of a lobe, with value / pdf.
struct LocalSample {
  Vec3d direction;
  double quotient, pdf;
};

// Reflection by rough facets at one hit. v points to the eye, above the surface; w to the light.
class Glossy {
 public:
  Glossy(const RtsLobe& lobe, uint32_t hit)
      : facets_(lobe.parameter[0][hit]), eta_(lobe.parameter[1][hit]) {}
  LobeValue evaluate(const Vec3d& v, const Vec3d& w) const {
    if (!(w.z > 0)) return {};
    const Vec3d h = unit(v + w);
    const double d = facets_.distribution(h);
    return {float(reflectance(dot(v, h)) * d * facets_.shadowing(v, w) / (4 * v.z)),
            float(facets_.masking(v) * d / (4 * v.z))};
  }
  std::optional<LocalSample> sample(const Vec3d& v, double u1, double u2) const {
    const Vec3d h = facets_.visible(v, u1, u2);
    const Vec3d w = unit(2 * dot(v, h) * h + -1 * v);
    if (!(w.z > 0)) return {};
    return LocalSample{w, reflectance(dot(v, h)) * facets_.shadowing(v, w) / facets_.masking(v),
                       facets_.masking(v) * facets_.distribution(h) / (4 * v.z)};
  }

 private:
  double reflectance(double cosine) const { return eta_ > 0 ? fresnelAt(cosine, eta_) : 1; }
  Facets facets_;
  double eta_; // relative index for the Fresnel term; 0: no Fresnel term
};

// A rough dielectric boundary at one hit: reflection and refraction. v points to the eye, w to the
// light. eta_: index on the viewer's side over that on the far side.
class Boundary {
 public:
  Boundary(const RtsLobe& lobe, uint32_t hit)
      : facets_(lobe.parameter[1][hit]), eta_(lobe.parameter[0][hit]) {
    if (!(eta_ > 0) || !std::isfinite(eta_)) eta_ = 1;
  }
  LobeValue evaluate(const Vec3d& v, const Vec3d& w) const {
    double value, pdf;
    evaluateAt(v, w, value, pdf);
    return {float(value), float(pdf)};
  }
  // The low digits of the second random number choose between reflection and refraction; they are
  // as evenly distributed as the leading ones.
  std::optional<LocalSample> sample(const Vec3d& v, double u1, double u2) const {
    const Vec3d h = facets_.visible(v, u1, u2);
    const double choice = u2 * 4096.0 - std::floor(u2 * 4096.0), cosine = std::min(1.0, dot(v, h));
    if (!(cosine > 0)) return {};
    double behind;
    const double f = fresnel(cosine, eta_, behind);
    const bool reflected = choice < f;
    const Vec3d w =
        unit(reflected ? 2 * cosine * h + -1 * v : (eta_ * cosine - behind) * h + -eta_ * v);
    if (reflected ? !(w.z > 0) : !(w.z < 0)) return {};
    double value, pdf;
    evaluateAt(v, w, value, pdf);
    if (!(pdf > 0)) return {};
    return LocalSample{
        w, (reflected ? 1 : eta_ * eta_) * facets_.shadowing(v, w) / facets_.masking(v), pdf};
  }

 private:
  // Computes value and pdf for light from w. The facet normal that scatters it to v is on v's side.
  void evaluateAt(const Vec3d& v, const Vec3d& w, double& value, double& pdf) const {
    value = pdf = 0;
    if (!(v.z > 0) || w.z == 0) return;
    const bool reflected = w.z > 0;
    // Walter's equations 13 and 16, scaled by the index of the far side
    Vec3d h = reflected ? unit(v + w) : unit(eta_ * v + w);
    if (h.z < 0) h = -1 * h;
    const double vh = dot(v, h), wh = dot(w, h);
    if (!(vh > 0) || (reflected ? wh <= 0 : wh >= 0)) return;
    const double f = fresnelAt(vh, eta_), d = facets_.distribution(h);
    if (reflected) {
      value = f * d * facets_.shadowing(v, w) / (4 * v.z);
      pdf = f * facets_.masking(v) * d / (4 * v.z);
      return;
    }
    const double root = eta_ * vh + wh; // with radiance scaled by eta^2, as at the smooth boundary
    if (root == 0) return;
    const double spread = std::fabs(wh) / (root * root);
    pdf = (1 - f) * facets_.visiblePdf(v, h) * spread;
    value = (1 - f) * d * facets_.shadowing(v, w) * vh * spread / v.z * eta_ * eta_;
  }
  Facets facets_;
  double eta_; // index on the viewer's side over that on the far side
};

// A lobe of microfacets at one hit. Transforms directions between the world and the frame of the
// lobe, in which `Model` (Glossy, Boundary) computes.
template <class Model> class MicrofacetLobe {
 public:
  MicrofacetLobe(const RtsLobe& lobe, const RtsHits& hits, uint32_t hit)
      : frame_(lobe, hit), model_(lobe, hit),
        eye_(unit(frame_.toLocal(-load(hits.direction, hit)))) {}
  LobeValue evaluate(const Vec3f& w) const {
    if (!(eye_.z > 0)) return {};
    return model_.evaluate(eye_, unit(frame_.toLocal(w)));
  }
  SampledDirection sample(float u1, float u2) const {
    SampledDirection out;
    if (!(eye_.z > 0)) return out;
    const std::optional<LocalSample> local = model_.sample(eye_, u1, u2);
    if (!local) return out;
    out.direction = frame_.toWorld(local->direction);
    out.quotient = float(local->quotient);
    out.pdf = float(local->pdf);
    return out;
  }

 private:
  Frame frame_;
  Model model_;
  Vec3d eye_;
};

// Function tables
// -------------------------------------------------------------------------------------------------

// Implements RtsLobeFunctions::evaluate hit by hit.
template <class Lobe> void evaluateEach(const RtsLobe* lobe, const RtsHits* hits, uint32_t n,
                                        const uint32_t* hit, const float* const direction[3],
                                        float* const value[3], float* pdf) {
  for (uint32_t i = 0; i < n; i++) {
    const LobeValue at = Lobe(*lobe, *hits, hit[i]).evaluate(load(direction, i));
    store(Vec3f{at.value, at.value, at.value}, value, i);
    pdf[i] = at.pdf;
  }
}

// Implements RtsLobeFunctions::sample hit by hit.
template <class Lobe> void sampleEach(const RtsLobe* lobe, const RtsHits* hits, uint32_t n,
                                      const uint32_t* hit, const float* const square[2],
                                      float* const direction[3], float* const quotient[3],
                                      float* pdf) {
  for (uint32_t i = 0; i < n; i++) {
    const SampledDirection at = Lobe(*lobe, *hits, hit[i]).sample(square[0][i], square[1][i]);
    store(at.direction, direction, i);
    store(Vec3f{at.quotient, at.quotient, at.quotient}, quotient, i);
    pdf[i] = at.pdf;
  }
}

template <class Lobe> constexpr RtsLobeFunctions functionsOf(uint32_t transmits) {
  return {sizeof(RtsLobeFunctions), transmits, evaluateEach<Lobe>, sampleEach<Lobe>};
}

constexpr RtsLobeFunctions diffuse = {sizeof(RtsLobeFunctions), 0, evaluateLambert, sampleLambert};
constexpr RtsLobeFunctions glossy = functionsOf<MicrofacetLobe<Glossy>>(0);
constexpr RtsLobeFunctions boundary = functionsOf<MicrofacetLobe<Boundary>>(1);

float checked(float v) { return v > 0 && std::isfinite(v) ? v : 0.0f; }

} // namespace

const RtsLobeFunctions* nonSpecularFunctions(const RtsLobe& lobe) {
  switch (lobe.kind) {
  case RTS_LOBE_DIFFUSE: return &diffuse;
  case RTS_LOBE_GLOSSY: return &glossy;
  case RTS_LOBE_ROUGH_DIELECTRIC: return &boundary;
  case RTS_LOBE_CUSTOM: return lobe.functions;
  default: return nullptr;
  }
}

bool weightAt(const RtsLobe& lobe, uint32_t hit, Vec3f& out) {
  const Vec3f w = load(lobe.weight, hit);
  out = {checked(w.x), checked(w.y), checked(w.z)};
  return largest(out) > 0;
}

bool transmitsAt(const RtsBatch& batch, uint32_t hit) {
  Vec3f ignored;
  for (uint32_t l = 0; l < batch.lobes.size(); l++) {
    const RtsLobeFunctions* functions = nonSpecularFunctions(batch.lobes[l]);
    if (functions && functions->transmits && weightAt(batch.lobes[l], hit, ignored)) return true;
  }
  return false;
}

const uint32_t* transmitsByHit(const RtsBatch& batch) {
  const auto transmits = [](const RtsLobe& lobe) {
    const RtsLobeFunctions* functions = nonSpecularFunctions(lobe);
    return functions && functions->transmits;
  };
  if (std::none_of(batch.lobes.begin(), batch.lobes.end(), transmits)) return nullptr;
  const uint32_t n = batch.points->hits.count;
  auto* transmitting = batch.arena.take<uint32_t>(padded(n));
  for (uint32_t i = 0; i < n; i++) transmitting[i] = transmitsAt(batch, i);
  return transmitting;
}

namespace {

// Returns the class that added the lobes of a batch; null if it is not known.
const RtsClass* classOf(const RtsBatch* batch) {
  if (!batch || !batch->points || batch->points->record[0] == noHit) return nullptr;
  return (*batch->scene.shaders)[batch->scene.records[batch->points->record[0]].shader].shaderClass;
}

// Calls a function of a plug-in's lobe; crashes are attributed to its class.
template <class F> void callCustom(const RtsBatch* batch, const F& f) {
  std::optional<RunningShader> running;
  if (const RtsClass* shaderClass = classOf(batch)) running.emplace(*shaderClass);
  f();
}

// Replaces negative values and values that are not finite in the output of a plug-in's lobe, and
// counts the latter. Hits that do not have the lobe, which other hits of the batch have, do not
// count: there its numbers are all 0.
void checkCustom(const RtsBatch* batch, const RtsLobe& lobe, const uint32_t* hit,
                 std::initializer_list<float*> arrays, uint32_t n) {
  const auto has = [&](uint32_t i) {
    return lobe.weight[0][hit[i]] != 0 || lobe.weight[1][hit[i]] != 0 ||
           lobe.weight[2][hit[i]] != 0;
  };
  uint64_t bad = 0;
  for (float* a : arrays)
    for (uint32_t i = 0; i < n; i++) {
      bad += !std::isfinite(a[i]) && has(i);
      a[i] = checked(a[i]);
    }
  const RtsClass* shaderClass = bad ? classOf(batch) : nullptr;
  if (shaderClass) batch->counters.faults.add(*shaderClass, Fault::notFinite, bad);
}

} // namespace

LobeValues::LobeValues(Arena& arena, uint32_t n, const RtsBatch* batch) : batch_(batch) {
  for (auto& a : value) a = arena.take<float>(padded(n));
  pdf = arena.take<float>(padded(n));
}

void LobeValues::evaluate(const RtsLobe& lobe, const RtsHits& hits, uint32_t n, const uint32_t* hit,
                          const float* const directions[3]) {
  if (lobe.kind != RTS_LOBE_CUSTOM)
    return nonSpecularFunctions(lobe)->evaluate(&lobe, &hits, n, hit, directions, value, pdf);
  callCustom(batch_,
             [&] { lobe.functions->evaluate(&lobe, &hits, n, hit, directions, value, pdf); });
  checkCustom(batch_, lobe, hit, {value[0], value[1], value[2], pdf}, n);
}

LobeSamples::LobeSamples(Arena& arena, uint32_t n, const RtsBatch* batch)
    : LobeValues(arena, n, batch) {
  for (auto& a : direction) a = arena.take<float>(padded(n));
}

void LobeSamples::sample(const RtsLobe& lobe, const RtsHits& hits, uint32_t n, const uint32_t* hit,
                         const float* const square[2]) {
  if (lobe.kind != RTS_LOBE_CUSTOM)
    return nonSpecularFunctions(lobe)->sample(&lobe, &hits, n, hit, square, direction, value, pdf);
  callCustom(batch_,
             [&] { lobe.functions->sample(&lobe, &hits, n, hit, square, direction, value, pdf); });
  checkCustom(batch_, lobe, hit, {value[0], value[1], value[2], pdf}, n);
  for (uint32_t i = 0; i < n; i++) { // a direction that is not normalised counts as no sample
    const Vec3f d = load(direction, i);
    if (!(std::fabs(dot(d, d) - 1) < 1e-3f)) pdf[i] = 0;
  }
}

} // namespace openrt
