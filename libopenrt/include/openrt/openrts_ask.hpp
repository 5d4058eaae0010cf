// openrts_ask.hpp: the member functions of Tracer and Hit that call the host: rays, random numbers,
// textures and attributes of the hit. Part of openrts.hpp. [render]
#ifndef OPENRT_OPENRTS_ASK_HPP
#define OPENRT_OPENRTS_ASK_HPP

#include "openrts.hpp"

namespace rts {
namespace detail {

// Writes a vector to all lanes, because the host may read whole vectors.
inline void spread(Vec3 v, float (&to)[3][RTS_LANES]) {
  for (int i = 0; i < RTS_LANES; i++) {
    to[0][i] = v.x;
    to[1][i] = v.y;
    to[2][i] = v.z;
  }
}

// A request of one ray, with arrays of RTS_LANES.
struct OneRay {
  OneRay(const Tracer& from, const Vec3* start, Vec3 direction, float end) {
    for (int i = 0; i < RTS_LANES; i++) {
      hit[i] = from.lane;
      length[i] = end;
    }
    spread(direction, towards);
    if (start) spread(*start, origin);
    request.count = 1;
    request.hit = hit;
    for (int k = 0; k < 3; k++) {
      request.origin[k] = start ? origin[k] : nullptr;
      request.direction[k] = towards[k];
    }
    request.length = end < infinity ? length : nullptr;
  }
  alignas(64) float origin[3][RTS_LANES], towards[3][RTS_LANES], length[RTS_LANES];
  alignas(64) uint32_t hit[RTS_LANES];
  RtsRequest request{};
};

inline float* lanes(const Tracer& t) { return t.host->scratch(t.batch, t.count); }
inline uint32_t* wholeNumbers(const Tracer& t) { return reinterpret_cast<uint32_t*>(lanes(t)); }

// Fills the six arrays of `cache` by a host function that writes two vectors. Returns false if
// there is no batch of hits.
template <class F> bool askVectors(const Tracer& t, F RtsHost::*member, float* (&cache)[6]) {
  if (cache[0]) return true;
  if (!t.asked) return false;
  for (float*& array : cache) array = lanes(t);
  float* const first[3] = {cache[0], cache[1], cache[2]};
  float* const second[3] = {cache[3], cache[4], cache[5]};
  (t.host->*member)(t.batch, first, second);
  return true;
}

} // namespace detail

inline Color Tracer::traceFrom(const Vec3* origin, Vec3 direction, float length,
                               float* alpha) const {
  const detail::OneRay ray(*this, origin, direction, length);
  alignas(64) float out[4][RTS_LANES] = {};
  float* const rgba[4] = {out[0], out[1], out[2], alpha ? out[3] : nullptr};
  host->trace(batch, &ray.request, rgba);
  if (alpha) *alpha = out[3][0];
  return {out[0][0], out[1][0], out[2][0]};
}

inline Found Tracer::findFrom(const Vec3* origin, Vec3 direction, float length) const {
  Found found;
  const detail::OneRay ray(*this, origin, direction, length);
  alignas(64) float out[10][RTS_LANES] = {};
  alignas(64) uint32_t name[RTS_LANES] = {};
  RtsFound table{};
  table.distance = out[9];
  for (int k = 0; k < 3; k++) {
    table.position[k] = out[k];
    table.geometric[k] = out[3 + k];
    table.normal[k] = out[6 + k];
  }
  table.name = name;
  host->findHit(batch, &ray.request, &table);
  found.distance = out[9][0];
  if (!found.any()) return found;
  found.position = {out[0][0], out[1][0], out[2][0]};
  found.geometric = {out[3][0], out[4][0], out[5][0]};
  found.normal = {out[6][0], out[7][0], out[8][0]};
  found.name = name[0];
  return found;
}

inline Color Tracer::occludedFrom(const Vec3* origin, Vec3 direction, float length) const {
  const detail::OneRay ray(*this, origin, direction, length);
  alignas(64) float out[3][RTS_LANES] = {};
  float* const transmission[3] = {out[0], out[1], out[2]};
  host->occluded(batch, &ray.request, transmission);
  return {out[0][0], out[1][0], out[2][0]};
}

inline Vec2 Tracer::random(uint32_t pair) const {
  if (!asked || pair >= 4) return {0.5f, 0.5f};
  float*(&square)[2] = asked->random[pair];
  if (!square[0]) {
    for (float*& axis : square) axis = detail::lanes(*this);
    float* const out[2] = {square[0], square[1]};
    host->random(batch, pair, out);
  }
  return {square[0][lane], square[1][lane]};
}

inline Vec4 Hit::sample(Texture texture, Vec2 place) const {
  if (texture.id == 0) return {1, 1, 1, 1}; // the same value as from the host
  alignas(64) float in[2][RTS_LANES], out[4][RTS_LANES];
  for (int i = 0; i < RTS_LANES; i++) {
    in[0][i] = place.x;
    in[1][i] = place.y;
  }
  const float* const uvs[2] = {in[0], in[1]};
  float* const rgba[4] = {out[0], out[1], out[2], out[3]};
  host->sample(batch, texture.id, 1, uvs, rgba);
  return {out[0][0], out[1][0], out[2][0], out[3][0]};
}

inline Vec4 Hit::sampleVolume(Texture texture, Vec3 place) const {
  if (texture.id == 0) return {1, 1, 1, 1};
  alignas(64) float in[3][RTS_LANES], out[4][RTS_LANES];
  detail::spread(place, in);
  const float* const str[3] = {in[0], in[1], in[2]};
  float* const rgba[4] = {out[0], out[1], out[2], out[3]};
  host->sampleVolume(batch, texture.id, 1, str, rgba);
  return {out[0][0], out[1][0], out[2][0], out[3][0]};
}

inline bool Hit::pixel(Vec2& place) const {
  alignas(64) float in[3][RTS_LANES], out[2][RTS_LANES];
  detail::spread(position, in);
  const float* const at[3] = {in[0], in[1], in[2]};
  float* const xy[2] = {out[0], out[1]};
  if (!host->pixels(batch, 1, at, xy)) return false;
  place = {out[0][0], out[1][0]};
  return true;
}

inline Hit::Local Hit::local() const {
  if (!detail::askVectors(*this, &RtsHost::local, asked->local)) return {position, geometric};
  float* const* a = asked->local;
  return {{a[0][lane], a[1][lane], a[2][lane]}, {a[3][lane], a[4][lane], a[5][lane]}};
}

inline Vec4Of<Lanes> HitOf<Lanes>::sample(Texture texture, Vec2Of<Lanes> place) const {
  if (texture.id == 0) return Vec4{1, 1, 1, 1};
  alignas(64) float in[2][RTS_LANES], out[4][RTS_LANES];
  for (uint32_t i = 0; i < RTS_LANES; i += Lanes::size) { // the host may read whole vectors
    place.x.store(in[0] + i);
    place.y.store(in[1] + i);
  }
  const float* const uvs[2] = {in[0], in[1]};
  float* const rgba[4] = {out[0], out[1], out[2], out[3]};
  first.host->sample(first.batch, texture.id, Lanes::size, uvs, rgba);
  return {Lanes::load(out[0]), Lanes::load(out[1]), Lanes::load(out[2]), Lanes::load(out[3])};
}

inline LocalOf<Lanes> HitOf<Lanes>::local() const {
  detail::Asked& asked = *first.asked;
  if (!detail::askVectors(first, &RtsHost::local, asked.local)) return {position, geometric};
  Lanes a[6];
  for (int k = 0; k < 6; k++) a[k] = Lanes::load(asked.local[k] + first.lane);
  return {{a[0], a[1], a[2]}, {a[3], a[4], a[5]}};
}

inline Hit::Derivatives Hit::derivatives() const {
  if (!detail::askVectors(*this, &RtsHost::derivatives, asked->derivatives)) return {};
  float* const* a = asked->derivatives;
  return {{a[0][lane], a[1][lane], a[2][lane]}, {a[3][lane], a[4][lane], a[5][lane]}};
}

inline Hit::Ids Hit::ids() const {
  uint32_t*(&a)[3] = asked->ids;
  if (!a[0]) {
    for (uint32_t*& array : a) array = detail::wholeNumbers(*this);
    host->ids(batch, a[0], a[1], a[2]);
  }
  return {a[0][lane], a[1][lane], a[2][lane]};
}

namespace detail {
// Returns what was asked, with depths and throughputs.
inline const Asked& askPath(const Tracer& t) {
  Asked& a = *t.asked;
  if (a.depth) return a;
  a.depth = wholeNumbers(t);
  for (float*& array : a.throughput) array = lanes(t);
  t.host->path(t.batch, a.depth, a.throughput);
  return a;
}
} // namespace detail

inline uint32_t Hit::depth() const { return detail::askPath(*this).depth[lane]; }

inline Color Hit::throughput() const {
  float* const* t = detail::askPath(*this).throughput;
  return {t[0][lane], t[1][lane], t[2][lane]};
}

inline float Hit::error() const {
  if (!asked->error) {
    asked->error = detail::lanes(*this);
    host->error(batch, asked->error);
  }
  return asked->error[lane];
}

} // namespace rts

#endif
