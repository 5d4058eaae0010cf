// openrt_shaders.cpp: nanoseconds a hit of shaders of openrts.hpp, hit by hit and with lanes
// (docs/shaders.md, section 7). Items are hits.
#include <benchmark/benchmark.h>

#include "abi/fake_host.h"
#include "openrt/openrts.hpp"

using namespace openrt::test;

namespace {

constexpr uint32_t count = 4096;

// A point light: a few products, a square root and a division.
struct Lamp {
  rts::Param<rts::Vec3> location{"location", {0, 3, 0}, "place of the light"};
  rts::Param<rts::Color> color{"color", {1, 1, 1}, "strength at distance 1"};
  template <class F> rts::IlluminationOf<F> at(rts::Vec3Of<F> point) const {
    const rts::Vec3Of<F> way = *location - point;
    const F far = rts::length(way);
    return {way, *color * rts::select(far < 10, 1 / rts::larger(far * far, 1), 0), {}};
  }
};
struct HitByHit : rts::LightSource<HitByHit>, Lamp {
  rts::Illumination illuminate(rts::Vec3 point) const { return at(point); }
};
struct InLanes : rts::LightSource<InLanes>, Lamp {
  template <class F> rts::IlluminationOf<F> illuminate(rts::Vec3Of<F> point) const {
    return at(point);
  }
};

// A surface with one lobe and a colour from a formula.
struct Paint {
  rts::Param<rts::Color> front{"front", {.8f, .7f, .6f}, "colour of the front"};
  rts::Param<rts::Color> back{"back", {.1f, .2f, .3f}, "colour of the back"};
  template <class F> void add(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    const F edge = 1 - hit.cosine();
    const rts::ColorOf<F> albedo = rts::select(hit.back(), *back, *front) * (1 - edge * edge);
    out.diffuse(albedo);
    out.albedo(albedo);
  }
};
struct PaintHitByHit : rts::Surface<PaintHitByHit>, Paint {
  void surface(const rts::Hit& hit, rts::Closures& out) const { add(hit, out); }
};
struct PaintInLanes : rts::Surface<PaintInLanes>, Paint {
  template <class F> void surface(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    add(hit, out);
  }
};

struct Arrays {
  explicit Arrays(size_t n) : lanes(n) {
    for (size_t k = 0; k < n; k++) {
      lanes[k] = Lanes(count);
      for (uint32_t i = 0; i < count; i++) lanes[k][i] = float((i * 37 + k * 11) % 101) / 101;
    }
  }
  float* operator[](size_t k) { return lanes[k].data(); }
  std::vector<Lanes> lanes;
};

template <class T> const RtsClass& classOf() {
  static const RtsClass* const c = rts::detail::classOf<T>("bench");
  return *c;
}

void setItems(benchmark::State& state) {
  state.SetItemsProcessed(int64_t(state.iterations()) * count);
}

template <class T> void light(benchmark::State& state) {
  FakeHost host;
  const ParamBlock params(classOf<T>());
  Arrays in(3), out(9);
  const float* const local[3] = {in[0], in[1], in[2]};
  RtsIllumination lit{
      {out[0], out[1], out[2]}, {out[3], out[4], out[5]}, {out[6], out[7], out[8]}, 0};
  for (auto _ : state)
    classOf<T>().illuminate(&host, host.batch(), params.get(), count, local, &lit);
  setItems(state);
}
BENCHMARK(light<HitByHit>)->Name("shader/point light, hit by hit");
BENCHMARK(light<InLanes>)->Name("shader/point light, lanes");

template <class T> void surface(benchmark::State& state) {
  FakeHost host;
  host.hitCount = count;
  const ParamBlock params(classOf<T>());
  Arrays in(19), out(6);
  const std::vector<uint32_t> flags(count, 0);
  const std::vector<const void*> pointers(count, params.get());
  RtsHits hits{};
  for (size_t k = 0; k < 3; k++) {
    hits.position[k] = in[k];
    hits.direction[k] = in[3 + k];
    hits.geometric[k] = in[6 + k];
    hits.normal[k] = in[9 + k];
  }
  for (size_t k = 0; k < 2; k++) hits.uv[k] = in[12 + k];
  for (size_t k = 0; k < 4; k++) hits.color[k] = in[14 + k];
  hits.distance = hits.segment = in[18];
  hits.count = count;
  hits.flags = flags.data();
  hits.params = pointers.data();
  RtsSurface result{{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
  RtsLobe* const lobe = host.newLobe(RTS_LOBE_DIFFUSE, nullptr, 0);
  static RtsLobe* made; // the same lobe for every batch: its memory is not part of the measurement
  made = lobe;
  host.RtsHost::lobe = [](RtsBatch*, RtsLobeKind) { return made; };
  for (auto _ : state) classOf<T>().surface(&host, host.batch(), &hits, &result);
  setItems(state);
}
BENCHMARK(surface<PaintHitByHit>)->Name("shader/surface of one lobe, hit by hit");
BENCHMARK(surface<PaintInLanes>)->Name("shader/surface of one lobe, lanes");

} // namespace
