// marble.cpp: the surface shader Marble, a solid texture of veins distorted by turbulence (K.
// Perlin, "An Image Synthesizer", SIGGRAPH 1985). [render]
#include "coat.h"
#include "pattern.h"

namespace {

struct Marble : rts::Surface<Marble> {
  static constexpr const char* text = "carved from marble: bent veins, polish";
  rts::Param<rts::Color> stone{
      "stone", {0.85f, 0.84f, 0.8f}, "fraction of light that the stone scatters, 0..1", 0, 1};
  rts::Param<rts::Color> vein{
      "vein", {0.25f, 0.27f, 0.3f}, "fraction of light that the veins scatter, 0..1", 0, 1};
  rts::Param<rts::Vec3> across{
      "across", {1, 0.6f, 0.2f}, "direction across the veins, in the object's space"};
  rts::Param<float> veins{"veins", 2, "veins per unit of length", 0, 1e6f};
  rts::Param<float> turbulence{"turbulence", 2, "how far the veins are bent, in veins", 0, 10};
  rts::Param<float> sharpness{"sharpness", 4, "how thin the veins are, >= 1", 1, 64};
  rts::Param<float> polish{"polish", 1, "index of refraction of the polish; 1: none", 1, 3};

  uint32_t needs() const { return polish > 1.001f ? RTS_SPECULAR | RTS_GLOSSY : 0; }
  void surface(const rts::Hit& hit, rts::Closures& out) const {
    coat::add(hit, out, colour(pattern::positionBeneath(hit, veins > 0 ? 1 / float(veins) : 1)),
              polish);
  }

 private:
  rts::Color colour(rts::Vec3 place) const {
    const rts::Vec3 d = rts::length(across) > 0 ? rts::normalize(across) : rts::Vec3{1, 0, 0};
    const rts::Vec3 p = float(veins) * place;
    const float at = rts::dot(p, d) + turbulence * pattern::turbulence(0.7f * p, 5);
    const float wave = 0.5f + 0.5f * std::cos(2 * rts::pi * (at - std::floor(at)));
    return pattern::lerp(stone, vein, std::pow(wave, float(sharpness)));
  }
};

} // namespace

RTS_PLUGIN(Marble)
