// cost.h: when is a thing that appears several times worth an object with instances? The one place where memory is weighed
// against speed. Pure numbers; used by the grouping (summary.cpp).
//
// What memory costs, measured with the local backend: a triangle 100 bytes where triangles share vertices, 150 where they do
// not (arrays, their copy in the kernel's frame, acceleration structure); an instance 1500 (232 of them in the API). What time
// costs: rays that meet instances run at a third to a quarter of the speed of rays in one merged mesh (tests/bench/map_memory.cpp
// and decision 12), and the smaller the instanced things are the more of them a ray meets. So an instance must replace several
// times itself, unless the memory saved is large by any measure.
#pragma once

#include <cstdint>
#include <limits>

namespace xvrml::mapping {

inline uint64_t addSaturating(uint64_t a, uint64_t b) {
  return a > std::numeric_limits<uint64_t>::max() - b ? std::numeric_limits<uint64_t>::max() : a + b;
}
inline uint64_t multiplySaturating(uint64_t a, uint64_t b) {
  return b != 0 && a > std::numeric_limits<uint64_t>::max() / b ? std::numeric_limits<uint64_t>::max() : a * b;
}

inline constexpr uint64_t bytesOfPrimitive = 150, bytesOfInstance = 1500;
// What things take in all, in the scene graph's mapper, the API and the renderer: what the budget of a world counts by
// (base/budget.h). Measured as the growth of the process by worlds of 100,000 of each, and rounded up.
inline constexpr uint64_t bytesOfItem = 600;         // a node that is drawn, placed or shines
inline constexpr uint64_t bytesOfPlace = 900;        // each place of a node that depends on it
inline constexpr uint64_t bytesOfLight = 900;        // each place of a light that shines
inline constexpr uint64_t bytesOfLightShader = 2400; // each light node that shines
inline constexpr uint64_t bytesOfShape = 1000;       // a shape written into an object, beside its primitives
inline constexpr uint64_t bytesOfRecord = 320;       // a further shape in an instance, flattened: the first is in bytesOfInstance
inline constexpr uint64_t bytesOfSurface = 2500;     // an appearance
inline constexpr uint64_t bytesOfOption = 200;       // an option of an ORTShader, beside its text and numbers
inline constexpr uint64_t copiesOfOption = 2;        // of those: in the renderer's scene, and in the shader's parameters there
inline constexpr uint64_t bytesWhileBuilt = 150;     // a triangle in a mesh and in what it is made of

inline constexpr uint64_t replaced = 3;                    // instances' worth that one instance must replace ...
inline constexpr uint64_t savedSome = 256 << 10;           // ... if this much is saved in all
inline constexpr uint64_t savedMuch = uint64_t(256) << 20; // whatever it replaces, if this much is

// Memory that instances save for a thing of so many primitives that would be written `times` times; 0 if they cost some.
inline uint64_t savedByInstances(uint64_t primitives, uint64_t times) {
  const uint64_t one = multiplySaturating(primitives, bytesOfPrimitive);
  if (times < 2 || one <= bytesOfInstance) return 0;
  const uint64_t saved = multiplySaturating(one - bytesOfInstance, times - 1); // by all but the first
  return saved > bytesOfInstance ? saved - bytesOfInstance : 0;
}

// merged: asked to be written out rather than instantiated (ORTStatic): only a large saving counts.
inline bool worthInstances(uint64_t primitives, uint64_t times, bool merged = false) {
  const uint64_t saved = savedByInstances(primitives, times), one = multiplySaturating(primitives, bytesOfPrimitive);
  if (saved >= savedMuch) return true;
  return !merged && one >= replaced * bytesOfInstance && saved >= savedSome;
}

} // namespace xvrml::mapping
