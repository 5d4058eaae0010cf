// fake_host.h: the smallest host a shader can run in, for tests of plug-ins without a renderer: constant textures, lights given
// as numbers, scratch memory, and a record of what the shader asked for.
#pragma once

#include <array>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "openrt/openrts.h"

namespace openrt::test {

// 64-byte aligned floats, padded to whole lanes by copies of the last value.
class Lanes {
 public:
  explicit Lanes(uint32_t n = 0, float value = 0) { assign(std::vector<float>(n, value)); }
  Lanes(std::vector<float> values) { assign(std::move(values)); }
  float* data() { return reinterpret_cast<float*>((reinterpret_cast<uintptr_t>(memory_.data()) + 63) / 64 * 64); }
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
  float toLight[3]; // unit
  float color[3] = {1, 1, 1};
  float ambient[3] = {0, 0, 0};
  float visible = 1; // what shadow() multiplies with
};

struct FakeHost : RtsHost {
  std::vector<FakeTexture> textures; // texture k + 1
  std::vector<FakeLight> shining;
  uint32_t shadowCalls = 0, shadowLanes = 0, sampleCalls = 0, messages = 0;
  std::deque<Lanes> memory;
  std::array<Lanes, 9> light;

  FakeHost();
  RtsBatch* batch() { return reinterpret_cast<RtsBatch*>(this); }
};

inline FakeHost& fake(RtsBatch* batch) { return *reinterpret_cast<FakeHost*>(batch); }

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
  shadow = [](RtsBatch* b, uint32_t i, const RtsHits* hits, const uint8_t* wanted, RtsIllumination* light) {
    FakeHost& host = fake(b);
    host.shadowCalls++;
    for (uint32_t k = 0; k < hits->count; k++) {
      if (!wanted[k]) continue;
      host.shadowLanes++;
      for (float* color : light->color) color[k] *= host.shining[i].visible;
    }
  };
  // u moves the red component, so that tests see which coordinates arrive.
  sample = [](RtsBatch* b, RtsTexture texture, uint32_t n, const float* const uv[2], float* const rgba[4]) {
    FakeHost& host = fake(b);
    host.sampleCalls++;
    const float white[4] = {1, 1, 1, 1};
    const float* value = texture == 0 ? white : host.textures[texture - 1].rgba;
    for (size_t c = 0; c < 4; c++)
      for (uint32_t i = 0; i < n; i++) rgba[c][i] = value[c] + (c == 0 && texture != 0 ? 10 * uv[0][i] + 100 * uv[1][i] : 0);
  };
  RtsHost::components = [](const RtsHost* h, RtsTexture texture) {
    return texture == 0 ? 0u : static_cast<const FakeHost*>(h)->textures[texture - 1].components;
  };
  scratch = [](RtsBatch* b, uint32_t n) {
    fake(b).memory.emplace_back(n, 1e30f); // not initialised means: nothing to rely on
    return fake(b).memory.back().data();
  };
  log = [](const RtsHost* h, int, const char*) { static_cast<FakeHost*>(const_cast<RtsHost*>(h))->messages++; };
}

// A parameter struct with a class's defaults.
class ParamBlock {
 public:
  explicit ParamBlock(const RtsClass& shaderClass) : class_(shaderClass), bytes_(shaderClass.paramSize / 8 + 1) {
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
      write<RtsFloats>(p.offset, {lists_.back().data(), static_cast<uint32_t>(lists_.back().size())});
    } else {
      std::memcpy(data() + p.offset, v.data(), floats(p.type) * sizeof(float));
    }
  }
  void setInt(const char* name, int v) { write<int32_t>(find(name).offset, v); } // integers and textures
  const void* get() const { return bytes_.data(); }

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
  template <class T> void write(uint32_t offset, T value) { std::memcpy(data() + offset, &value, sizeof value); }

  const RtsClass& class_;
  std::vector<uint64_t> bytes_;
  std::deque<std::vector<float>> lists_;
};

} // namespace openrt::test
