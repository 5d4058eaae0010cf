// limits.h: limits on what a hostile file may cost. Every limit has a name, used in messages and by
// `vv --limit NAME=VALUE`.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace xvrml {

struct Limits {
  uint64_t nesting = 1000;             // nodes within nodes, and statements within statements
  uint64_t protoDepth = 64;            // prototypes instantiating prototypes
  uint64_t inlineDepth = 32;           // files within files, Scripts made by Scripts
  uint64_t expandedNodes = 10'000'000; // nodes after all prototypes and USEs are expanded
  // Memory of everything made from a world's files (estimated); 0: an eighth of the machine's
  // memory.
  uint64_t worldBytes = 0;
  uint64_t interfaceFields = 10'000; // declarations in one PROTO, EXTERNPROTO or Script
  uint64_t stringBytes = 64ull << 20;
  uint64_t arrayElements = 400'000'000; // numbers in one MF field
  uint64_t fileBytes = 4ull << 30;      // one file, after gunzip
  uint64_t inflateRatio = 200;          // gunzipped over gzipped size (files above 1 MiB unpacked)
  uint64_t inflateBytes = 1ull << 30;
  uint64_t imagePixels = 256ull << 20;
  uint64_t triangles = 200'000'000; // triangles made by one geometry node
};

struct LimitInfo {
  std::string_view name;
  uint64_t Limits::*value;
  std::string_view text;
};
std::span<const LimitInfo> limitTable();
// Sets a limit by name. Returns false if there is no such limit.
bool setLimit(Limits& limits, std::string_view name, uint64_t value);

} // namespace xvrml
