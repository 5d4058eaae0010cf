# Gives KiCad's materials shaders: sed -i -f materials.sed shapes3D/*.wrl
# Models name their Materials (PIN-01, MET-ALUMINUM ...); each keeps its colours for other browsers.
/ORTShader/b
s/appearance Appearance {[[:space:]]*material DEF PIN-02/appearance ORTAppearance { shader ORTShader { name "Metal" file "metal" options "color n .143 .375 1.442 color k 3.983 2.386 1.603 1f roughness .2" } material DEF PIN-02/
s/appearance Appearance {[[:space:]]*material DEF \(PIN-\|MET-\)/appearance ORTAppearance { shader ORTShader { name "Metal" file "metal" options "1f roughness .22" } material DEF \1/
s/appearance Appearance {[[:space:]]*material DEF \(IC-BODY\|PLASTIC-\|RES-\|CAP-\)/appearance ORTAppearance { shader ORTShader { name "Plastic" file "plastic" options "1f roughness .35" } material DEF \1/
s/appearance Appearance {[[:space:]]*material DEF LED-RED/appearance ORTAppearance { shader ORTShader { name "Glass" file "glass" options "1f index 1.5 color absorption .4 9 12" } material DEF LED-RED/
