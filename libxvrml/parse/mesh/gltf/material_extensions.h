// material_extensions.h: Reads the extensions of glTF's materials that decide which node draws a
// surface. [the thread that loads]
#pragma once

#include <optional>
#include <vector>

#include "parse/mesh/gltf/json.h"
#include "xvrml/types.h"

namespace xvrml::gltf {

// Returns three numbers between 0 and 1 as a colour, or the fallback if there are none.
Color colorOf(const std::vector<double>& numbers, Color fallback);

// Returns whether the surface reflects nothing at its boundary, so that it scatters all light
// evenly: specularFactor or specularColorFactor is 0, or the index of refraction 1
// (KHR_materials_specular, KHR_materials_ior).
bool isMatt(const Item& material);

// A clear body: KHR_materials_transmission with KHR_materials_ior, KHR_materials_volume and
// KHR_materials_dispersion.
struct ClearBody {
  double index = 1.5;
  double alpha = 0; // width of GGX; 0: polished
  double abbe = 0;  // Abbe number; 0: all colours have the same index
  Color tint{1, 1, 1};
  Color absorption{0, 0, 0}; // per metre
};
// Returns what a material of a clear body has. Nothing for opaque surfaces, and for walls without
// thickness, which do not refract.
std::optional<ClearBody> clearBodyOf(const Item& material);

} // namespace xvrml::gltf
