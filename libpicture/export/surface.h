// surface.h: The look of a shape by the terms of physically based materials, whatever node or
// shader it comes from. All formats of exports take it from here, and the z-buffer renderer does.
// [the thread that owns the world]
#pragma once

#include <array>
#include <optional>
#include <string>

#include "libpicture/export/picture_source.h"
#include "libpicture/export/remarks.h"
#include "libpicture/export/shader_values.h"
#include "xvrml/renderer.h"

namespace picture {

// A picture of a surface.
struct SurfacePicture {
  const xvrml::Node* node = nullptr; // the texture node, for its repetition
  size_t file = 0;                   // place in the PictureSource
  // Texture coordinates s t of the geometry become (a s + c t + e, b s + d t + f).
  std::array<float, 6> transform{1, 0, 0, 1, 0, 0}; // a b c d e f
};

// Colours are linear: VRML97 and X3D write sRGB codes, which are decoded.
struct Surface {
  std::string name; // the DEF name of the appearance or of its material; may be empty
  bool visible = true;
  bool lit = true; // false: the surface shows its colour in any light
  // The intensity of a light is its irradiance at the surface, as in X3D 4 (17.2.2), and not pi
  // times as much, as a white Material that reflects all light takes it.
  bool takesIrradiance = false;
  xvrml::Color color{1, 1, 1};   // diffuse reflectance, or F0 for a metal
  bool showsVertexColors = true; // the colours of vertices multiply `color`, which is white then
  enum class Alpha : uint8_t { opaque, mask, blend } alpha = Alpha::opaque;
  float opacity = 1, alphaCutoff = 0.5f;
  float metallic = 0, roughness = 1; // roughness is the root of the width alpha of GGX
  xvrml::Color emission{0, 0, 0};    // may exceed 1
  // Formats with Phong's model take a colour, which is linear, too, and an exponent instead of
  // roughness.
  xvrml::Color specular{0, 0, 0};
  float exponent = 0;
  float index = 1.5f, transmission = 0, dispersion = 0, clearcoat = 0;
  bool isMatt = false;              // without the reflection that the index would give it
  xvrml::Color absorption{0, 0, 0}; // inside, per metre
  std::optional<SurfacePicture> picture, emissivePicture, normalPicture, metallicRoughnessPicture,
      occlusionPicture;
  float normalScale = 1, occlusionStrength = 1;
};

// The colours that a geometry has of its own. Those of a ColorRGBA may be transparent; its
// opacities stand in place of that of the material (ISO/IEC 19775-1 11.4.3).
enum class VertexColors : uint8_t { none, opaque, transparent };

// Returns the linear value of an sRGB colour, each part from 0 to 1.
xvrml::Color linearOf(const xvrml::Color& code);
// Returns the sRGB colour of a linear one.
xvrml::Color codeOf(const xvrml::Color& linear);

// Returns the roughness that makes highlights about as wide as Phong's exponent 128 shininess does:
// the root of the width alpha of GGX with alpha^2 = 2 / (exponent + 2) (Walter et al. 2007, section
// 5.2, for Beckmann, whose width is nearly the same).
float roughnessOfShininess(float shininess);

// Returns the reflectance of a metal in perpendicular light, from the real and imaginary part of
// its index of refraction (Fresnel's equations).
float reflectanceOf(float n, float k);

// Makes surfaces of appearances.
class Surfaces {
 public:
  Surfaces(PictureSource& pictures, const std::string& shaderPath, Remarks& remarks)
      : pictures_(pictures), remarks_(remarks), shaders_(shaderPath) {}
  // lines: the geometry consists of lines or points, which are neither lit nor textured (ISO/IEC
  // 14772-1 6.24, 6.36).
  Surface make(const xvrml::AppearanceParts& parts, VertexColors colors, bool lines);

 private:
  void setMaterial(const xvrml::AppearanceParts& parts, Surface& surface);
  void setColorPicture(const xvrml::AppearanceParts& parts, const xvrml::MaterialValues& values,
                       Surface& surface);
  void setShader(const xvrml::AppearanceParts& parts, Surface& surface);
  std::optional<SurfacePicture> pictureOf(const xvrml::AppearanceParts& parts,
                                          xvrml::Node* texture);
  std::optional<SurfacePicture> ownPicture(const xvrml::AppearanceParts& parts,
                                           const ShaderValues& values,
                                           const std::optional<SurfacePicture>& other);
  void remarkLost(const xvrml::AppearanceParts& parts, const xvrml::MaterialValues& values);

  PictureSource& pictures_;
  Remarks& remarks_;
  ShaderTables shaders_;
};

} // namespace picture
