// x3d_params.h: the parameters of the class X3DMaterial: those of VRML97, and what X3D adds to a
// Material: several layers of pictures, pictures of each term, and a back of its own. [render]
#pragma once

#include "vrml97/material.h"

namespace vrml97 {

// The pictures of the terms of one side; 0 where it has none.
struct TermPictures {
  RtsTexture ambient, emissive, specular, shininess, normal;
};

inline constexpr uint32_t maxLayers = 8;         // `texture` and the following pictures
inline constexpr uint32_t numbersPerLayer = 4;   // in `layers`
inline constexpr uint32_t numbersPerMatrix = 16; // in `layerTransforms`

// The values of cubeLookup: by which direction the first layer is looked up in a cube map.
enum CubeLookup : int32_t { noCube, byReflection, byNormal };
inline constexpr uint32_t cubeFaces = 6; // front, back, left, right, top, bottom

// The values of alphaMode.
enum AlphaMode : int32_t { alphaOpaque, alphaMask, alphaBlend };

struct X3dParams {
  SurfaceParams front; // first: functions for SurfaceParams work on both
  TermPictures pictures[2];
  RtsTexture further[maxLayers - 1];
  RtsFloats layers, layerTransforms;
  float factor[4];
  int32_t twoSided;
  float backDiffuseColor[3], backEmissiveColor[3], backSpecularColor[3];
  float backAmbientIntensity, backShininess, backTransparency;
  int32_t backPicture;
  RtsTexture backTexture;
  float normalScale[2];
  int32_t alphaMode;
  float alphaCutoff;
  int32_t filled;
  int32_t hatchStyle; // 0: no hatching (hatch.h)
  float hatchColor[3];
  int32_t cubeLookup;
  RtsTexture cube[cubeFaces], cubeMap;
  int32_t mirror;
  int32_t inSpace;       // textures are placed by texturePlace where its q is not 0
  float texturePlace[4]; // (s, t, r, q) of a vertex
};

struct ParamList {
  const RtsParam* data;
  const uint8_t* frequency;
  uint32_t count;
};
// Returns the declarations of all parameters.
ParamList x3dParams();

inline const X3dParams& x3dParamsOf(const RtsHits* hits, uint32_t lane) {
  return *static_cast<const X3dParams*>(hits->params[lane]);
}
// Returns 1 where a hit is on a back that has values of its own, else 0.
inline uint32_t sideOf(const X3dParams& p, uint32_t flags) {
  return p.twoSided && (flags & RTS_HIT_BACK) && !(flags & RTS_HIT_LINE) ? 1 : 0;
}

} // namespace vrml97
