// cost.h: weighs memory against rendering speed: decides when a thing that appears several times
// becomes an object with instances. Pure functions; called by summary.cpp.
//
// Memory, measured with the local backend (arrays, their copy in the kernel's frame, acceleration
// structure):
// * a triangle takes 100 bytes where triangles share vertices, 150 where they do not;
// * an instance takes 1500 bytes, 232 of them in the API.
//
// Time: rays through instances run at a third to a quarter of the speed of rays in one merged mesh
// (tests/bench/mapper_memory.cpp and decision 12). The smaller the instanced things are, the more
// of them a ray meets. So an instance must replace several times its own memory, unless the total
// saving is large.
#pragma once

#include <cstdint>
#include <limits>

namespace xvrml::mapper {

inline uint64_t addSaturating(uint64_t a, uint64_t b) {
  return a > std::numeric_limits<uint64_t>::max() - b ? std::numeric_limits<uint64_t>::max()
                                                      : a + b;
}
inline uint64_t multiplySaturating(uint64_t a, uint64_t b) {
  return b != 0 && a > std::numeric_limits<uint64_t>::max() / b
             ? std::numeric_limits<uint64_t>::max()
             : a * b;
}

inline constexpr uint64_t bytesOfPrimitive = 150, bytesOfInstance = 1500;
// Memory of each thing in all layers together: the mapper, the API and the renderer. The world's
// budget (base/budget.h) is counted in these units. They were measured as the growth of the process
// with worlds of 100,000 of each thing, and rounded up.

// A node that is drawn, depends on its place or is a light.
inline constexpr uint64_t bytesOfItem = 600;
inline constexpr uint64_t bytesOfPlace = 900;        // each place of a place-dependent node
inline constexpr uint64_t bytesOfLight = 900;        // each place of a light that is on
inline constexpr uint64_t bytesOfLightShader = 2400; // each light node that is on
// A shape written into an object, without its primitives.
inline constexpr uint64_t bytesOfShape = 1000;
// Each further shape of an instanced object, for each flattened instance; bytesOfInstance includes
// the first.
inline constexpr uint64_t bytesOfRecord = 320;
inline constexpr uint64_t bytesOfSurface = 2500; // an appearance with a shader of its own
// The part of it that an appearance takes which shares the shader of an equal one.
inline constexpr uint64_t bytesOfSharedSurface = 250;
// An option of an ORTShader, without its text and numbers.
inline constexpr uint64_t bytesOfOption = 200;
// Copies of an option's text and numbers: in the renderer's scene and in the shader's parameters.
inline constexpr uint64_t copiesOfOption = 2;
// A triangle in a mesh, with the data that it is built from.
inline constexpr uint64_t bytesWhileBuilt = 150;
// A triangle that ClipPlanes have cut: its new vertices with all that is interpolated, and what it
// takes when it is drawn.
inline constexpr uint64_t bytesWhileCut = 400;

// An instance must replace this many times its own memory and save minimumSaving bytes in all. A
// saving of largeSaving is enough in any case.
inline constexpr uint64_t minimumReplaced = 3;
inline constexpr uint64_t minimumSaving = 256 << 10;
inline constexpr uint64_t largeSaving = uint64_t(256) << 20;

// Returns the memory that instances save for a thing of `primitives` primitives that would
// otherwise be written `times` times. Returns 0 if they save nothing.
inline uint64_t savedByInstances(uint64_t primitives, uint64_t times) {
  const uint64_t one = multiplySaturating(primitives, bytesOfPrimitive);
  if (times < 2 || one <= bytesOfInstance) return 0;
  // The first copy is kept.
  const uint64_t saved = multiplySaturating(one - bytesOfInstance, times - 1);
  return saved > bytesOfInstance ? saved - bytesOfInstance : 0;
}

// Returns whether a thing should be instantiated. merged: the author asked to merge it (ORTStatic),
// so only a large saving counts.
inline bool worthInstances(uint64_t primitives, uint64_t times, bool merged = false) {
  const uint64_t saved = savedByInstances(primitives, times),
                 one = multiplySaturating(primitives, bytesOfPrimitive);
  if (saved >= largeSaving) return true;
  return !merged && one >= minimumReplaced * bytesOfInstance && saved >= minimumSaving;
}

} // namespace xvrml::mapper
