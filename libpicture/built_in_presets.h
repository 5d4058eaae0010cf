// built_in_presets.h: The presets that --preset of vv and preset= of Python know, in the format of
// vv.toml (docs/presets.md).
#pragma once

#include <string_view>

namespace picture {

inline constexpr std::string_view builtInPresets = R"toml(
[preset.studio]
from = "three-quarter"
studio = "#c8cacc"
clamp = 10

[preset.product]
preset = "studio"
studio = "white"

# From so far that parallel edges stay parallel, as in a drawing.
[preset.technical]
from = "three-quarter"
fov = 0.5
background = "white"
spp = 32

# kicad: finds the materials of KiCad's parts by name or colour, and the layers in files of glTF
# (decision 97). In VRML the layers have colours and a shininess of their own: .9 finish of the
# copper, .7 solder, .01 board (decision 76). Solder mask keeps its transparency. Cans and shields
# (MET-*) have the n and k of iron at 630, 532 and 465 nm, because aluminium would be white under a
# soft box.
[preset.pcb]
from = "above"
up = "z"
placeholders = true
studio = "#c8cacc"
clamp = 4
spp = 16
shader = [
  "colour:.72,.46,.21=Metal:n=.21,1.04,1.18:k=3.67,2.58,2.21:roughness=.5",
  "colour:.75,.72,.66=Metal:n=1.48,1.48,1.48:k=5.25,5.25,5.25:roughness=.4",
  "kicad:PIN-*=Metal:roughness=.25",
  "kicad:PIN-02=Metal:n=.143,.375,1.442:k=3.983,2.386,1.603:roughness=.25",
  "kicad:MET-*=Metal:n=2.91,2.95,2.58:k=3.09,2.93,2.77:roughness=.35",
  "kicad:MET-COPPER=Metal:n=.21,1.04,1.18:k=3.67,2.58,2.21:roughness=.4",
  "kicad:MET-BRONZE=Metal:n=.21,1.04,1.18:k=3.67,2.58,2.21:roughness=.5",
  "kicad:IC-BODY-*=Plastic:roughness=.45",
  "kicad:IC-LABEL-*=Diffuse",
  "kicad:PLASTIC-*=Plastic:roughness=.35",
  "kicad:CAP-CERAMIC-*=Plastic:roughness=.4",
  "kicad:RES-*=Plastic:roughness=.3",
  "kicad:BOARD-*=Plastic:roughness=.2",
  "kicad:RED-BODY=Plastic:roughness=.3",
  "kicad:LED-*=Plastic:roughness=.08",
  "kicad:GLASS-*=Plastic:roughness=.05",
  "kicad:layer-copper=Metal:n=.143,.375,1.442:k=3.983,2.386,1.603:roughness=.4",
  "kicad:layer-pad=Metal:n=1.48,1.48,1.48:k=5.25,5.25,5.25:roughness=.5",
  "kicad:layer-soldermask=Plastic:roughness=.2",
  "kicad:layer-silkscreen=Plastic:roughness=.2",
  "kicad:layer-board=Plastic:roughness=.2",
  "colour:.75,.61,.23,.9=Metal:n=.143,.375,1.442:k=3.983,2.386,1.603:roughness=.4",
  "colour:.7,.61,0,.9=Metal:n=.143,.375,1.442:k=3.983,2.386,1.603:roughness=.4",
  "colour:.84,.84,.84,.9=Metal:n=.05,.06,.04:k=4.21,3.59,2.66:roughness=.4",
  "colour:.63,.63,.63,.9=Metal:n=1.48,1.48,1.48:k=5.25,5.25,5.25:roughness=.4",
  "colour:.5,.5,.5,.7=Metal:n=1.48,1.48,1.48:k=5.25,5.25,5.25:roughness=.5",
  "colour:.4,.4,.4,.8=Metal:n=1.48,1.48,1.48:k=5.25,5.25,5.25:roughness=.5",
  "colour:.75,.76,.76,.8=Metal:n=1.48,1.48,1.48:k=5.25,5.25,5.25:roughness=.4",
  "colour:0,0,0,.01=Plastic:color=.155,.171,.073:roughness=.4",
  "*=Plastic:roughness=.2",
]
)toml";

} // namespace picture
