#include "parse/mesh/gltf/material_extensions.h"

#include <algorithm>
#include <cmath>

namespace xvrml::gltf {
namespace {

bool isBlack(const std::vector<double>& color) {
  return !color.empty() && std::all_of(color.begin(), color.end(), [](double x) { return x <= 0; });
}

// attenuationColor is what is left of white light after attenuationDistance (Beer-Lambert).
Color absorptionOf(const Item& volume) {
  const double distance = volume.number("attenuationDistance", 0);
  if (!(distance > 0)) return {0, 0, 0};
  const Color left = colorOf(volume.numbers("attenuationColor", 3), {1, 1, 1});
  constexpr double least = 1e-6, most = 1e6; // the shader's limit
  const auto part = [&](float value) {
    const double absorbed = -std::log(std::max(double(value), least)) / distance;
    return float(std::min(std::max(0.0, absorbed), most));
  };
  return {part(left.r), part(left.g), part(left.b)};
}

} // namespace

Color colorOf(const std::vector<double>& numbers, Color fallback) {
  if (numbers.size() < 3) return fallback;
  const auto part = [&](size_t i) { return float(std::clamp(numbers[i], 0.0, 1.0)); };
  return {part(0), part(1), part(2)};
}

bool isMatt(const Item& material) {
  const Item pbr = material.object("pbrMetallicRoughness");
  if (!pbr || pbr.number("metallicFactor", 1) > 0) return false;
  const Item specular = material.extension("KHR_materials_specular");
  return specular.number("specularFactor", 1) <= 0 ||
         isBlack(specular.numbers("specularColorFactor", 3)) ||
         material.extension("KHR_materials_ior").number("ior", 1.5) == 1;
}

std::optional<ClearBody> clearBodyOf(const Item& material) {
  const Item volume = material.extension("KHR_materials_volume");
  constexpr double mostly = 0.5;
  const bool clear =
      material.extension("KHR_materials_transmission").number("transmissionFactor", 0) > mostly &&
      volume.number("thicknessFactor", 0) > 0;
  if (!clear) return {};
  const Item pbr = material.object("pbrMetallicRoughness");
  ClearBody body;
  body.index = std::clamp(material.extension("KHR_materials_ior").number("ior", 1.5), 1.0, 10.0);
  const double roughness = std::clamp(pbr.number("roughnessFactor", 1), 0.0, 1.0);
  body.alpha = roughness * roughness;
  const double dispersion = material.extension("KHR_materials_dispersion").number("dispersion", 0);
  if (dispersion > 0) body.abbe = std::min(20 / dispersion, 1000.0);
  body.tint = colorOf(pbr.numbers("baseColorFactor", 4), {1, 1, 1});
  body.absorption = absorptionOf(volume);
  return body;
}

} // namespace xvrml::gltf
