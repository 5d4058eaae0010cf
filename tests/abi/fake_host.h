// fake_host.h: the smallest host that a shader can run in, for tests of plug-ins without a
// renderer. It has constant textures, lights given as numbers, lobes, scratch memory, rays that hit
// a floor, and a record of what the shader requested.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "openrt/openrts.h"

namespace openrt::test {

// 64-byte aligned floats. The last value is repeated up to a whole number of lanes.
class Lanes {
 public:
  explicit Lanes(uint32_t n = 0, float value = 0) { assign(std::vector<float>(n, value)); }
  Lanes(std::vector<float> values) { assign(std::move(values)); }
  float* data() {
    return reinterpret_cast<float*>((reinterpret_cast<uintptr_t>(memory_.data()) + 63) / 64 * 64);
  }
  float& operator[](size_t i) { return data()[i]; }

 private:
  void assign(std::vector<float> values) {
    const size_t n = values.size(), padded = (n + RTS_LANES - 1) / RTS_LANES * RTS_LANES;
    memory_.assign(padded + 16, 0.0f);
    for (size_t i = 0; i < padded; i++) data()[i] = n == 0 ? 0.0f : values[i < n ? i : n - 1];
  }
  std::vector<float> memory_;
};

struct FakeTexture {
  uint32_t components;
  float rgba[4];
};

struct FakeLight {
  float toLight[3]; // unit vector
  float color[3] = {1, 1, 1};
  float ambient[3] = {0, 0, 0};
  float visible = 1; // factor that shadow() applies to the light
};

// A lobe that the shader has added, with its memory.
struct FakeLobe {
  RtsLobe table{};
  std::array<Lanes, 8 + RTS_MAX_LOBE_FLOATS> memory;
};

struct FakeHost : RtsHost {
  std::vector<FakeTexture> textures; // textures[k] is texture k + 1
  std::vector<FakeLight> shining;
  uint32_t shadowCalls = 0, shadowLanes = 0, sampleCalls = 0, messages = 0;
  std::deque<Lanes> memory;
  std::array<Lanes, 9> light;
  std::deque<FakeLobe> lobes;
  uint32_t hitCount = 1; // hits in the batch; every function about hits fills this many values
  float normal[3] = {0, 0, 1}; // normal of new lobes
  // z of the plane that rays hit; the hit has radiance .25 .5 .75, alpha 1 and name 7
  float floor = -1;
  std::vector<uint32_t> requestHits; // RtsRequest.hit of each ray so far
  uint32_t randomCalls = 0;

  FakeHost();
  RtsLobe* newLobe(RtsLobeKind kind, const RtsLobeFunctions* functions, uint32_t floats);
  RtsBatch* batch() { return reinterpret_cast<RtsBatch*>(this); }
};

inline FakeHost& fake(RtsBatch* batch) { return *reinterpret_cast<FakeHost*>(batch); }

inline RtsLobe* FakeHost::newLobe(RtsLobeKind kind, const RtsLobeFunctions* functions,
                                  uint32_t floats) {
  if (lobes.size() == RTS_MAX_LOBES) return nullptr;
  FakeLobe& lobe = lobes.emplace_back();
  for (Lanes& m : lobe.memory) m = Lanes(hitCount);
  lobe.table.kind = kind;
  lobe.table.functions = functions;
  for (size_t k = 0; k < 3; k++) {
    lobe.memory[3 + k] = Lanes(hitCount, normal[k]);
    lobe.table.weight[k] = lobe.memory[k].data();
    lobe.table.normal[k] = lobe.memory[3 + k].data();
  }
  for (size_t k = 0; k < 2; k++) lobe.table.parameter[k] = lobe.memory[6 + k].data();
  for (size_t k = 0; k < floats; k++) lobe.table.data[k] = lobe.memory[8 + k].data();
  return &lobe.table;
}

// Returns the distance at which a ray meets the plane z = floor. Rays from hits start at the
// origin.
inline float fakeDistance(const FakeHost& host, const RtsRequest* rays, uint32_t i) {
  const float z = rays->origin[0] ? rays->origin[2][i] : 0, d = rays->direction[2][i];
  const float t = d < 0 ? (host.floor - z) / d : INFINITY;
  return t > 0 && (!rays->length || t < rays->length[i]) ? t : INFINITY;
}

inline void addRays(RtsHost& host) {
  host.trace = [](RtsBatch* b, const RtsRequest* rays, float* const rgba[4]) {
    for (uint32_t i = 0; i < rays->count; i++) {
      fake(b).requestHits.push_back(rays->hit[i]);
      const float met = std::isfinite(fakeDistance(fake(b), rays, i)) ? 1 : 0;
      for (uint32_t k = 0; k < 3; k++) rgba[k][i] = met * 0.25f * float(k + 1);
      if (rgba[3]) rgba[3][i] = met;
    }
  };
  host.findHit = [](RtsBatch* b, const RtsRequest* rays, RtsFound* out) {
    for (uint32_t i = 0; i < rays->count; i++) {
      fake(b).requestHits.push_back(rays->hit[i]);
      const float t = fakeDistance(fake(b), rays, i);
      if (out->distance) out->distance[i] = t;
      if (!std::isfinite(t)) continue;
      for (uint32_t k = 0; k < 3; k++) {
        if (out->position[k])
          out->position[k][i] =
              (rays->origin[0] ? rays->origin[k][i] : 0) + t * rays->direction[k][i];
        if (out->geometric[k]) out->geometric[k][i] = k == 2;
        if (out->normal[k]) out->normal[k][i] = k == 2;
      }
      if (out->name) out->name[i] = 7;
    }
  };
  host.occluded = [](RtsBatch* b, const RtsRequest* rays, float* const transmission[3]) {
    for (uint32_t i = 0; i < rays->count; i++)
      for (uint32_t k = 0; k < 3; k++)
        transmission[k][i] = std::isfinite(fakeDistance(fake(b), rays, i)) ? 0 : 1;
  };
}

// Adds the functions about hits. Their values differ by lane and array, so that tests notice a
// mix-up.
inline void addFacts(RtsHost& host) {
  host.random = [](RtsBatch* b, uint32_t pair, float* const square[2]) {
    fake(b).randomCalls++;
    for (uint32_t i = 0; i < fake(b).hitCount; i++)
      for (uint32_t k = 0; k < 2; k++)
        square[k][i] = 0.1f * float(pair) + 0.01f * float(k) + 0.001f * float(i);
  };
  const auto vectors = [](RtsBatch* b, float* const first[3], float* const second[3]) {
    for (uint32_t i = 0; i < fake(b).hitCount; i++)
      for (uint32_t k = 0; k < 3; k++) {
        first[k][i] = float(i) + 0.1f * float(k);
        second[k][i] = 10 + first[k][i];
      }
  };
  host.local = vectors;
  host.derivatives = vectors;
  host.ids = [](RtsBatch* b, uint32_t* name, uint32_t* instance, uint32_t* primitive) {
    for (uint32_t i = 0; i < fake(b).hitCount; i++) {
      name[i] = 100 + i;
      instance[i] = 200 + i;
      primitive[i] = 300 + i;
    }
  };
  host.path = [](RtsBatch* b, uint32_t* depth, float* const throughput[3]) {
    for (uint32_t i = 0; i < fake(b).hitCount; i++) {
      depth[i] = i;
      for (uint32_t k = 0; k < 3; k++) throughput[k][i] = 0.5f / float(k + 1);
    }
  };
  host.error = [](RtsBatch* b, float* error) {
    for (uint32_t i = 0; i < fake(b).hitCount; i++) error[i] = 1e-6f * float(i + 1);
  };
  host.backdrop = [](RtsBatch* b, uint32_t* seen) { std::fill_n(seen, fake(b).hitCount, 0u); };
}

inline FakeHost::FakeHost() : RtsHost{} {
  size = sizeof(RtsHost);
  major = RTS_ABI_MAJOR;
  minor = RTS_ABI_MINOR;
  RtsHost::lights = [](RtsBatch* b) { return static_cast<uint32_t>(fake(b).shining.size()); };
  illuminate = [](RtsBatch* b, uint32_t i, const RtsHits* hits, RtsIllumination* out) {
    FakeHost& host = fake(b);
    const FakeLight& l = host.shining[i];
    for (size_t c = 0; c < 3; c++) {
      host.light[c] = Lanes(hits->count, l.toLight[c]);
      host.light[3 + c] = Lanes(hits->count, l.color[c]);
      host.light[6 + c] = Lanes(hits->count, l.ambient[c]);
      out->toLight[c] = host.light[c].data();
      out->color[c] = host.light[3 + c].data();
      out->ambient[c] = host.light[6 + c].data();
    }
  };
  shadow = [](RtsBatch* b, uint32_t i, const RtsHits* hits, const uint8_t* wanted,
              RtsIllumination* light) {
    FakeHost& host = fake(b);
    host.shadowCalls++;
    for (uint32_t k = 0; k < hits->count; k++) {
      if (!wanted[k]) continue;
      host.shadowLanes++;
      for (float* color : light->color) color[k] *= host.shining[i].visible;
    }
  };
  // The red component depends on u, so that tests see which texture coordinates arrive.
  sample = [](RtsBatch* b, RtsTexture texture, uint32_t n, const float* const uv[2],
              float* const rgba[4]) {
    FakeHost& host = fake(b);
    host.sampleCalls++;
    const float white[4] = {1, 1, 1, 1};
    const float* value = texture == 0 ? white : host.textures[texture - 1].rgba;
    for (size_t c = 0; c < 4; c++)
      for (uint32_t i = 0; i < n; i++)
        rgba[c][i] = value[c] + (c == 0 && texture != 0 ? 10 * uv[0][i] + 100 * uv[1][i] : 0);
  };
  // The green component depends on r.
  sampleVolume = [](RtsBatch* b, RtsTexture texture, uint32_t n, const float* const str[3],
                    float* const rgba[4]) {
    FakeHost& host = fake(b);
    host.sample(b, texture, n, str, rgba);
    for (uint32_t i = 0; texture != 0 && i < n; i++) rgba[1][i] += 10 * str[2][i];
  };
  // The picture is the plane z = 0, with y down.
  pixels = [](RtsBatch*, uint32_t n, const float* const position[3], float* const xy[2]) {
    for (uint32_t i = 0; i < n; i++) {
      xy[0][i] = position[0][i];
      xy[1][i] = -position[1][i];
    }
    return 1;
  };
  RtsHost::components = [](const RtsHost* h, RtsTexture texture) {
    return texture == 0 ? 0u : static_cast<const FakeHost*>(h)->textures[texture - 1].components;
  };
  scratch = [](RtsBatch* b, uint32_t n) {
    // uninitialised memory: shaders must not rely on its content
    fake(b).memory.emplace_back(n, 1e30f);
    return fake(b).memory.back().data();
  };
  log = [](const RtsHost* h, int, const char*) {
    static_cast<FakeHost*>(const_cast<RtsHost*>(h))->messages++;
  };
  RtsHost::lobe = [](RtsBatch* b, RtsLobeKind kind) {
    return kind == RTS_LOBE_CUSTOM ? nullptr : fake(b).newLobe(kind, nullptr, 0);
  };
  customLobe = [](RtsBatch* b, const RtsLobeFunctions* functions, uint32_t floats) {
    return floats > RTS_MAX_LOBE_FLOATS ? nullptr
                                        : fake(b).newLobe(RTS_LOBE_CUSTOM, functions, floats);
  };
  addRays(*this);
  addFacts(*this);
}

// A parameter block filled with the defaults of a shader class.
class ParamBlock {
 public:
  explicit ParamBlock(const RtsClass& shaderClass)
      : class_(shaderClass), bytes_(shaderClass.paramSize / 8 + 1) {
    for (uint32_t i = 0; i < class_.paramCount; i++) {
      const RtsParam& p = class_.params[i];
      if (p.type == RTS_INT)
        write<int32_t>(p.offset, static_cast<int32_t>(p.defaultValue[0]));
      else if (p.type == RTS_STRING)
        write<const char*>(p.offset, "");
      else if (p.type >= RTS_FLOAT && p.type <= RTS_MATRIX)
        std::memcpy(data() + p.offset, p.defaultValue, floats(p.type) * sizeof(float));
    }
  }
  void set(const char* name, std::vector<float> v) {
    const RtsParam& p = find(name);
    if (p.type == RTS_FLOATS) {
      lists_.push_back(std::move(v));
      write<RtsFloats>(p.offset,
                       {lists_.back().data(), static_cast<uint32_t>(lists_.back().size())});
    } else {
      std::memcpy(data() + p.offset, v.data(), floats(p.type) * sizeof(float));
    }
  }
  // Sets an integer or a texture.
  void setInt(const char* name, int v) { write<int32_t>(find(name).offset, v); }
  const void* get() const { return bytes_.data(); }
  void* get() { return bytes_.data(); }

 private:
  static size_t floats(RtsType type) {
    switch (type) {
    case RTS_VEC2: return 2;
    case RTS_VEC3:
    case RTS_COLOR: return 3;
    case RTS_VEC4: return 4;
    case RTS_MATRIX: return 16;
    default: return 1;
    }
  }
  const RtsParam& find(const char* name) const {
    for (uint32_t i = 0; i < class_.paramCount; i++)
      if (std::strcmp(class_.params[i].name, name) == 0) return class_.params[i];
    throw std::runtime_error(std::string("no parameter ") + name);
  }
  char* data() { return reinterpret_cast<char*>(bytes_.data()); }
  template <class T> void write(uint32_t offset, T value) {
    std::memcpy(data() + offset, &value, sizeof value);
  }

  const RtsClass& class_;
  std::vector<uint64_t> bytes_;
  std::deque<std::vector<float>> lists_;
};

} // namespace openrt::test
