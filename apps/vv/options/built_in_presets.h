// built_in_presets.h: The presets that --preset knows, in the format of vv.toml (docs/presets.md).
#pragma once

#include <string_view>

namespace vv {

inline constexpr std::string_view builtInPresets = R"toml(
[preset.studio]
from = "three-quarter"
studio = "#c8cacc"
clamp = 10

[preset.product]
preset = "studio"
studio = "white"

[preset.technical]
from = "three-quarter"
background = "white"
spp = 32

# Materials of KiCad's library have names; the layers of its exporter have colours alone.
[preset.pcb]
from = "above"
studio = "#c8cacc"
clamp = 4
spp = 12
shader = [
  "colour:.72,.46,.21=Metal:n=.2,.92,1.1:k=3.9,2.45,2.14:roughness=.3",
  "colour:.4,.4,.4=Metal:roughness=.3",
  "colour:.75,.72,.66=Metal:roughness=.3",
  "material:PIN-*=Metal:roughness=.25",
  "material:PIN-02=Metal:n=.143,.375,1.442:k=3.983,2.386,1.603:roughness=.25",
  "material:MET-*=Metal:roughness=.3",
  "material:MET-COPPER=Metal:n=.2,.92,1.1:k=3.9,2.45,2.14:roughness=.3",
  "material:MET-BRONZE=Metal:n=.2,.92,1.1:k=3.9,2.45,2.14:roughness=.4",
  "material:IC-BODY-*=Plastic:roughness=.45",
  "material:IC-LABEL-*=Diffuse",
  "material:PLASTIC-*=Plastic:roughness=.35",
  "material:CAP-CERAMIC-*=Plastic:roughness=.4",
  "material:RES-*=Plastic:roughness=.3",
  "material:BOARD-*=Plastic:roughness=.2",
  "material:RED-BODY=Plastic:roughness=.3",
  "material:LED-*=Plastic:roughness=.08",
  "material:GLASS-*=Plastic:roughness=.05",
  "*=Plastic:roughness=.2",
]
)toml";

} // namespace vv
