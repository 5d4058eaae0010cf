// light_path_weights.h: multiple importance sampling between camera paths and the light paths that
// a glossy surface scatters first (LightSources::Kind::glossy). Both make these paths: the first
// surface that the camera sees, and the last one before an emissive shape, are two different ones;
// the first scatters the path by any lobe, the last by one that is neither specular nor
// RTS_LOBE_DIFFUSE. [render]
//
// Camera paths find the emitter by light sampling or by BSDF sampling, whose balance heuristic
// (emitted.h) stays as it is. The power heuristic (E. Veach, 1997, 9.2) divides the light between
// them and the light paths. Its ratio of pdfs is
//   light paths / camera paths = start C (f / (f + e)) product of (back / ahead)
// with, for each surface but the first, the projected pdfs of its lobe (projected_pdfs.h): ahead of
// the direction to the light, back of that to the camera. At the first surface `back` is the number
// of pixels over those that a unit of its area covers (render/path/light_path_ratios.h).
// Geometry terms are in both. start C: pdf of the first ray of a light path. f: pdf of the
// direction to the emitter at the last surface by its lobe, e: that by light sampling.
//
// Weights may be any function of the path that both sides compute alike, so what only one of them
// knows is left out: Russian roulette, selection among lobes, the cosine at the emitter and the
// place on the lens. Specular surfaces and straight passages between the two have the factor 1.
// A path that skips a culled back face has the ratio 0, because it cannot be run the other way.
#pragma once

#include <cmath>

#include "render/lights/light_rays.h"
#include "render/wave/batch.h"

namespace openrt {

// Return the weights of both for a ratio of pdfs.
inline float lightPathShare(float ratio) {
  if (!(ratio > 0)) return 0;
  const float square = ratio * ratio;
  return square < 1e30f ? square / (1 + square) : 1.0f;
}
inline float cameraPathShare(float ratio) { return 1 - lightPathShare(ratio); }

// Returns whether a non-specular lobe of the first surface has scattered a camera path.
inline bool isScatteredFirst(PathFlags path) {
  return path.pathClass() == PathClass::diffuse || path.pathClass() == PathClass::caustic;
}
// Returns whether a lobe may be that of the last surface.
inline bool isGlossy(const RtsLobe& lobe) { return lobe.kind != RTS_LOBE_DIFFUSE; }
// Returns whether light paths start towards the surface at hit i.
bool isAimedAt(const RtsBatch& batch, uint32_t i);

// Returns the ratio for a path whose last surface sends on the light of a point of a shape.
// surfaces: the product over its surfaces. glossyPdf, lightPdf: f and e.
float lightPathRatio(const RenderScene& scene, uint32_t shape, const Vec3f& place, float surfaces,
                     float glossyPdf, float lightPdf);

// Returns the weights of the camera paths for light samples at the hits of a batch by a lobe, by
// ray; null: they are 1. pdf: of the lobe, by ray.
const float* cameraPathShares(const RtsBatch& batch, const RtsLobe& lobe, const float* pdf,
                              const LightSamples& samples);

} // namespace openrt
