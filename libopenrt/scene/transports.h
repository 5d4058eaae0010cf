// transports.h: the one table of light transports (RT_TRANSPORT_*) and of what distinguishes them.
// rtQuality and readers of recordings and messages check values against it, rtGetTransportInfo
// publishes it, and the renderer reads its properties. [any thread]
#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "openrt/frame.h"

namespace openrt {

// The ways in which transports shade hits: the name of each, and the function of PathTracer
// (render/path/path_tracer.h) that does it.
//   byShade  by `shade`, and by lobes only if a class has no `shade`
//   byLobes  by lobes, and by `shade` only if a class has no lobes
#define OPENRT_SHADINGS(X)                                                                         \
  X(byShade, shadeByShade)                                                                         \
  X(byLobes, shadeByLobes)

#define OPENRT_ENUMERATOR(name, function) name,
enum class Shading : uint8_t { OPENRT_SHADINGS(OPENRT_ENUMERATOR) };
#undef OPENRT_ENUMERATOR

// The texts are described at RTtransportInfo.
struct TransportTraits {
  RTenum transport; // RT_TRANSPORT_*
  const char* name;
  const char* text;
  const char* claim;
  uint32_t omits = 0;       // RT_LEAVES_*: kinds of light that it does not follow everywhere
  bool tracesPaths = false; // follows light between surfaces, with random decisions
  bool tracesLamps = false; // also traces paths that start at lamps
  Shading shading = Shading::byShade;
};

// The rows are in the order of RT_TRANSPORT_*. RT_TRANSPORT_AUTO is resolved before a frame is
// rendered.
inline constexpr TransportTraits transports[] = {
    {.transport = RT_TRANSPORT_AUTO,
     .name = "auto",
     .text = "chooses by the shaders of the world",
     .claim = "the engine did not report its transport"},
    {.transport = RT_TRANSPORT_DIRECT,
     .name = "direct",
     .text = "only direct light",
     .claim = "direct light from lamps and emitters, {shadows}: exact at each point",
     .omits = RT_LEAVES_IMAGES | RT_LEAVES_BETWEEN | RT_LEAVES_EMITTERS | RT_LEAVES_SKY},
    {.transport = RT_TRANSPORT_WHITTED,
     .name = "whitted",
     .text = "also mirrors and glass",
     .claim = "direct light from lamps and emitters, {shadows}, with its reflections and "
              "refractions at up to "
              "{depth} surfaces, down to the energy cut: exact at each point",
     .omits = RT_LEAVES_BETWEEN | RT_LEAVES_EMITTERS | RT_LEAVES_SKY},
    {.transport = RT_TRANSPORT_PATH,
     .name = "path",
     .text = "also light between surfaces",
     .claim = "all light on paths of at most {depth} surfaces that can be sampled from the camera: "
              "an unbiased "
              "estimate",
     .omits = RT_LEAVES_CAUSTICS,
     .tracesPaths = true,
     .shading = Shading::byLobes},
    {.transport = RT_TRANSPORT_LIGHT,
     .name = "light",
     .text = "also light from lamps through mirrors and lenses",
     .claim = "all light on paths of at most {depth} surfaces, including light from lamps through "
              "mirrors and "
              "lenses: an unbiased estimate",
     .omits = RT_LEAVES_CAUSTICS,
     .tracesPaths = true,
     .tracesLamps = true,
     .shading = Shading::byLobes},
};

constexpr bool isTransport(RTenum transport) { return transport < std::size(transports); }
// Returns the row of a transport; that of RT_TRANSPORT_AUTO for an unknown number.
constexpr const TransportTraits& traitsOf(RTenum transport) {
  return transports[isTransport(transport) ? transport : RTenum(RT_TRANSPORT_AUTO)];
}
constexpr bool tracesPaths(RTenum transport) { return traitsOf(transport).tracesPaths; }
constexpr bool tracesLamps(RTenum transport) { return traitsOf(transport).tracesLamps; }
constexpr bool followsImages(RTenum transport) {
  return !(traitsOf(transport).omits & RT_LEAVES_IMAGES);
}

static_assert(
    [] {
      for (size_t i = 0; i < std::size(transports); i++)
        if (transports[i].transport != i) return false;
      return true;
    }(),
    "the rows are not in the order of RT_TRANSPORT_*");

// The names with blanks between them, terminated by zero (RTqualityInfo.choices).
inline constexpr auto transportChoices = [] {
  constexpr size_t length = [] {
    size_t sum = 0;
    for (const TransportTraits& row : transports) sum += std::string_view(row.name).size() + 1;
    return sum;
  }();
  std::array<char, length> text{};
  size_t end = 0;
  for (const TransportTraits& row : transports) {
    if (end > 0) text[end++] = ' ';
    for (const char c : std::string_view(row.name)) text[end++] = c;
  }
  return text;
}();

} // namespace openrt
