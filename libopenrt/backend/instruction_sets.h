// instruction_sets.h: the names of the instruction sets that Embree's kernels are compiled for, as
// the configuration of contexts (isa=NAME), RTstats.machine.isa and the cluster's messages have
// them. [any]
#pragma once

#include <string>
#include <string_view>

namespace openrt {

// Best first. A processor that has one of them has those after it, too.
#if defined(__aarch64__)
inline constexpr std::string_view instructionSets[] = {"neon"};
#else
inline constexpr std::string_view instructionSets[] = {"avx512", "avx2", "avx", "sse4.2", "sse2"};
#endif

// Stands for the best instruction set that the machine has.
inline constexpr std::string_view automaticIsa = "auto";

// Returns the names from `best` on, separated by ", ". An unknown name gives an empty text.
inline std::string instructionSetsFrom(std::string_view best) {
  std::string names;
  for (const std::string_view name : instructionSets)
    if (name == best || !names.empty()) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

// Returns whether a name is one of a list that instructionSetsFrom() has made.
inline bool listsInstructionSet(const std::string& list, const std::string& name) {
  return (", " + list + ", ").find(", " + name + ", ") != std::string::npos;
}

} // namespace openrt
