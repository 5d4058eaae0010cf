// light_path_weights.h: multiple importance sampling between camera paths and the light paths that
// a glossy surface scatters first (LightSources::Kind::glossy). Both make these paths: the first
// non-specular surface of the camera path, and the last one before an emissive shape, are two
// different ones; the first scatters the path by any lobe, the last by one that is neither specular
// nor RTS_LOBE_DIFFUSE. Light paths are connected to the camera if it sees the first one, and to
// the first one itself if the camera sees it by way of mirrors or glass (surface_connections.h).
// [render]
//
// Camera paths find the emitter by light sampling or by BSDF sampling, whose balance heuristic
// (emitted.h) stays as it is. The power heuristic (E. Veach, 1997, 9.2) divides the light between
// them and the light paths. Its ratio of pdfs is
//   light paths / camera paths = start C (f / (f + e)) product of (back / ahead)
// with, for each surface but the first, the projected pdfs of its lobe (projected_pdfs.h): ahead of
// the direction to the light, back of that to the camera. At the first surface `back` is the number
// of pixels over those that a unit of its area covers (render/path/light_path_ratios.h).
// Geometry terms are in both. A connection to the first surface leaves out one of them, G, so there
// the first surface has connections per camera path / (ahead G), and the second 1 instead of
// `back`. start C: pdf of the first ray of a light path. f: pdf of the direction to the emitter at
// the last surface by its lobe, e: that by light sampling.
//
// Weights may be any function of the path that both sides compute alike, so what only one of them
// knows is left out: Russian roulette, selection among lobes, the cosine at the emitter and the
// place on the lens. Specular surfaces and straight passages between the two have the factor 1;
// only right behind a first surface to which light paths are connected there may be no specular
// one. A path that skips a culled back face has the ratio 0, because it cannot be run the other
// way.
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

// There is one light path by way of glossy surfaces for so many other light paths, of which there
// are about as many as camera paths. More cost more than they gain (docs/decisions/0090).
inline constexpr uint32_t camerasPerGlossyPath = 4;
// Returns whether light paths by way of glossy surfaces make paths of a kind.
inline bool sharesGlossy(const RenderScene& scene, PathFlags path) {
  return path.pathClass() == PathClass::specularFirst ? scene.connectsGlossy : scene.showsGlossy;
}

// Returns the number of light paths that are connected to the surface of a camera path, on average;
// 0 where it is not the first non-specular one, or not seen by way of specular ones.
float connectionsAt(const RenderScene& scene, PathFlags path, const Vec3f& throughput);
// Returns the ratio that this number stands for: the ratio counts light paths that are not by way
// of glossy surfaces, of which there are more.
inline float connectionRatio(float connections) {
  return connections * float(camerasPerGlossyPath);
}
// Returns the squared distance of two points over the cosine at the second one: the geometry term
// of a connection is the cosine at the first point over it.
inline float spreadTo(const Vec3f& from, const Vec3f& to, const Vec3f& normal) {
  const Vec3f way = to - from;
  const float square = dot(way, way), height = std::fabs(dot(way, normal));
  return height > 0 ? square * std::sqrt(square) / height : 0.0f;
}
// Returns what a camera path has instead of `back` at hit i, by a lobe.
float backOfCameraPath(const RtsBatch& batch, const RtsLobe& lobe, uint32_t i, float back);
// Returns whether a lobe may be that of the last surface.
inline bool isGlossy(const RtsLobe& lobe) { return lobe.kind != RTS_LOBE_DIFFUSE; }
// Returns whether light paths start towards the surface at hit i.
bool isAimedAt(const RtsBatch& batch, uint32_t i);

// Return the ratio for a path whose last surface sends on the light of a point of a shape.
// surfaces: the product over its surfaces. glossyPdf, lightPdf: f and e. The second one is for
// paths that come to that surface by way of mirrors or smooth glass.
float lightPathRatio(const RenderScene& scene, uint32_t shape, const Vec3f& place, float surfaces,
                     float glossyPdf, float lightPdf);
float mirrorPathRatio(const RenderScene& scene, uint32_t shape, const Vec3f& place, float surfaces);

// Returns the weights of the camera paths for light samples at the hits of a batch by a lobe, by
// ray; null: they are 1. pdf: of the lobe, by ray.
const float* cameraPathShares(const RtsBatch& batch, const RtsLobe& lobe, const float* pdf,
                              const LightSamples& samples);

} // namespace openrt
