// surface_at_one_hit.h: runs a surface shader of a plug-in, with parameters, at one hit of the
// plane z = 0. Tests ask which lobes it adds there and evaluate and sample them. Used for tests of
// energy, reciprocity and sampling that hold for every shader.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "abi/fake_host.h"
#include "openrt/openrts.hpp"
#include "render/surface/lobes.h"
#include "shading/registry.h"

namespace openrt::test {

struct Setting {
  const char* parameter;
  std::vector<float> values;
};

// One lobe of a hit. The hit is owned by the SurfaceAtOneHit that made it.
struct LobeAtHit {
  const RtsLobe* lobe;
  const RtsHits* hits;

  RtsLobeKind kind() const { return lobe->kind; }
  rts::Color weight() const { return {lobe->weight[0][0], lobe->weight[1][0], lobe->weight[2][0]}; }
  rts::Vec3 normal() const { return {lobe->normal[0][0], lobe->normal[1][0], lobe->normal[2][0]}; }
  bool scatters() const { return nonSpecularFunctions(*lobe) != nullptr; }

  // Returns the BSDF times cosine, without the lobe's weight, and the pdf of `sample`.
  rts::Color value(rts::Vec3 direction, float* pdf = nullptr) const {
    const uint32_t hit = 0;
    float out[4] = {};
    const float* const d[3] = {&direction.x, &direction.y, &direction.z};
    float* const values[3] = {&out[0], &out[1], &out[2]};
    nonSpecularFunctions(*lobe)->evaluate(lobe, hits, 1, &hit, d, values, &out[3]);
    if (pdf) *pdf = out[3];
    return {out[0], out[1], out[2]};
  }
  rts::Sample sample(rts::Vec2 square) const {
    const uint32_t hit = 0;
    float out[7] = {};
    const float* const at[2] = {&square.x, &square.y};
    float* const direction[3] = {&out[0], &out[1], &out[2]};
    float* const quotient[3] = {&out[3], &out[4], &out[5]};
    nonSpecularFunctions(*lobe)->sample(lobe, hits, 1, &hit, at, direction, quotient, &out[6]);
    return {{out[0], out[1], out[2]}, {out[3], out[4], out[5]}, out[6]};
  }
};

class SurfaceAtOneHit {
 public:
  SurfaceAtOneHit(const char* name, const std::vector<Setting>& settings)
      : SurfaceAtOneHit(registry().find(name, ""), settings) {}
  SurfaceAtOneHit(const RtsClass& shaderClass, const std::vector<Setting>& settings)
      : class_(shaderClass), params_(class_) {
    for (const Setting& s : settings) {
      const RtsParam* p = nullptr;
      for (uint32_t i = 0; i < class_.paramCount; i++)
        if (std::string(class_.params[i].name) == s.parameter) p = &class_.params[i];
      if (p && p->type == RTS_INT)
        params_.setInt(s.parameter, int(s.values.at(0)));
      else
        params_.set(s.parameter, s.values);
    }
    if (class_.prepare) message_ = class_.prepare(&host_, params_.get());
  }
  ~SurfaceAtOneHit() {
    if (class_.release) class_.release(&host_, params_.get());
  }
  SurfaceAtOneHit(const SurfaceAtOneHit&) = delete;
  SurfaceAtOneHit& operator=(const SurfaceAtOneHit&) = delete;

  // Returns the lobes for a direction to the eye; valid until the next call. place: position in the
  // frame of the object.
  std::vector<LobeAtHit> lobes(rts::Vec3 toEye, rts::Vec3 place = {}, bool back = false) {
    host_.lobes.clear();
    host_.memory.clear();
    place_ = place;
    const float numbers[19] = {place.x, place.y, place.z, -toEye.x, -toEye.y, -toEye.z, 0, 0, 1, 0,
                               0,       1,       .25f,    .25f,     1,        1,        1, 1, 3};
    for (size_t k = 0; k < 19; k++) lanes_[k] = Lanes(1, numbers[k]);
    hits_ = {};
    hits_.count = 1;
    for (size_t k = 0; k < 3; k++) {
      hits_.position[k] = lanes_[k].data();
      hits_.direction[k] = lanes_[3 + k].data();
      hits_.geometric[k] = lanes_[6 + k].data();
      hits_.normal[k] = lanes_[9 + k].data();
      emission_[k] = Lanes(1);
      albedo_[k] = Lanes(1);
      out_.emission[k] = emission_[k].data();
      out_.albedo[k] = albedo_[k].data();
    }
    for (size_t k = 0; k < 2; k++) hits_.uv[k] = lanes_[12 + k].data();
    for (size_t k = 0; k < 4; k++) hits_.color[k] = lanes_[14 + k].data();
    hits_.distance = hits_.segment = lanes_[18].data();
    flags_.assign(RTS_LANES, back ? RTS_HIT_BACK : 0);
    pointers_.assign(RTS_LANES, params_.get());
    hits_.flags = flags_.data();
    hits_.params = pointers_.data();
    host_.local = [](RtsBatch* b, float* const position[3], float* const normal[3]) {
      const rts::Vec3 p = static_cast<Host&>(fake(b)).place;
      const float at[3] = {p.x, p.y, p.z};
      for (uint32_t k = 0; k < 3; k++) {
        position[k][0] = at[k];
        normal[k][0] = k == 2;
      }
    };
    host_.place = place;
    class_.surface(&host_, host_.batch(), &hits_, &out_);
    std::vector<LobeAtHit> all;
    for (const FakeLobe& l : host_.lobes) all.push_back({&l.table, &hits_});
    return all;
  }
  const RtsClass& shaderClass() const { return class_; }
  const void* params() const { return std::as_const(params_).get(); }
  FakeHost& host() { return host_; }
  const char* message() const { return message_; }
  rts::Color emission() { return {emission_[0][0], emission_[1][0], emission_[2][0]}; }

  static const ShaderRegistry& registry() {
    static const ShaderRegistry r(shaderFolders(""));
    return r;
  }

 private:
  struct Host : FakeHost {
    rts::Vec3 place;
  };
  const RtsClass& class_;
  Host host_;
  ParamBlock params_;
  const char* message_ = nullptr;
  Lanes lanes_[19], emission_[3], albedo_[3];
  std::vector<uint32_t> flags_;
  std::vector<const void*> pointers_;
  RtsHits hits_{};
  RtsSurface out_{};
  rts::Vec3 place_;
};

// Returns a direction of the upper hemisphere for angles in degrees.
inline rts::Vec3 towards(double fromNormal, double around = 0) {
  const double t = fromNormal * M_PI / 180, p = around * M_PI / 180;
  return {float(std::sin(t) * std::cos(p)), float(std::sin(t) * std::sin(p)), float(std::cos(t))};
}

// A small generator of independent random numbers (M. O'Neill, "PCG", 2014).
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed * 2 + 1) { operator()(); }
  float operator()() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005u + 1442695040888963407u;
    const uint32_t mixed = uint32_t(((old >> 18) ^ old) >> 27), turn = uint32_t(old >> 59);
    return float(((mixed >> turn) | (mixed << ((32 - turn) & 31))) >> 8) * 0x1p-24f;
  }

 private:
  uint64_t state_;
};

} // namespace openrt::test
