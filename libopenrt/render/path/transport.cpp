#include "render/path/transport.h"

#include <cstring>

#include "render/lights/emitters.h"
#include "render/media.h"
#include "render/medium/medium_lights.h"
#include "render/path/sensor_plane.h"
#include "render/render_scene.h"
#include "scene/transports.h"

namespace openrt {
namespace {

constexpr uint32_t light = hasLamps | hasEmitters | hasGlow | hasSky;

// Rules that choose the transport. Rows are tried from the top; a row whose `from` is the transport
// chosen so far replaces it. A transport is chosen only if it leaves out no light of lobe-only
// surfaces. Surfaces that have `shade` are drawn by their own lighting model (that of VRML97) until
// something that is meant as light shines on them.
struct Choice {
  RTenum from;
  // all: bits that must all be set. any: at least one must be set (0: no condition).
  uint32_t all, any;
  RTenum to;
  // {} stands for the class that set the first bit of `all`, [] for that of `any`
  const char* reason;
};
constexpr Choice choices[] = {
    {RT_TRANSPORT_AUTO, asksForAll, 0, RT_TRANSPORT_PATH, "{} needs interreflection"},
    {RT_TRANSPORT_AUTO, hasScattering, hasEmitters | hasGlow, RT_TRANSPORT_PATH,
     "{} scatters the light that [] emits"},
    {RT_TRANSPORT_AUTO, hasScattering, hasSky, RT_TRANSPORT_PATH,
     "{} scatters the light of the sky"},
    {RT_TRANSPORT_AUTO, hasScattering, hasLamps, RT_TRANSPORT_PATH,
     "{} scatters light of lamps from surface to surface"},
    {RT_TRANSPORT_AUTO, hasFog, 0, RT_TRANSPORT_PATH, "{} scatters or absorbs light inside"},
    {RT_TRANSPORT_AUTO, hasShading, hasEmitters, RT_TRANSPORT_PATH,
     "{} is lit by [], which emits light"},
    {RT_TRANSPORT_AUTO, hasShading, hasSkyLight, RT_TRANSPORT_PATH,
     "{} is lit by the environment []"},
    {RT_TRANSPORT_PATH, hasMirrors | hasStarts | hasProjection, 0, RT_TRANSPORT_LIGHT,
     ", and {} mirrors or refracts"},
    {RT_TRANSPORT_AUTO, hasMirrors, 0, RT_TRANSPORT_WHITTED,
     "{} mirrors or refracts; no surface needs light between surfaces"},
    {RT_TRANSPORT_AUTO, hasLobes, 0, RT_TRANSPORT_WHITTED,
     "{} has only lobes; no surface needs light between surfaces"},
    {RT_TRANSPORT_AUTO, 0, 0, RT_TRANSPORT_DIRECT, "no surface needs more than direct light"},
};

// Which scenes have a kind of light that a transport may omit. Transports that omit it
// (TransportTraits::omits) leave it out of these scenes, whether the user or the engine chose the
// transport.
struct Omission {
  uint32_t leaves; // RT_LEAVES_*
  uint32_t all, any;
};
constexpr Omission omissions[] = {
    {RT_LEAVES_IMAGES, hasMirrors, 0},
    {RT_LEAVES_BETWEEN, hasScattering, light},
    {RT_LEAVES_BETWEEN, hasShading, light},
    {RT_LEAVES_EMITTERS, hasScattering, hasEmitters | hasGlow},
    {RT_LEAVES_EMITTERS, hasShading, hasEmitters},
    {RT_LEAVES_SKY, hasScattering, hasSky},
    {RT_LEAVES_SKY, hasShading, hasSkyLight},
    {RT_LEAVES_CAUSTICS, hasMirrors | hasLamps | hasScattering, 0},
    {RT_LEAVES_CAUSTICS, hasMirrors | hasLamps | hasShading, 0},
};

bool holds(uint32_t bits, uint32_t all, uint32_t any) {
  return (bits & all) == all && (any == 0 || (bits & any));
}

const char* firstOf(const SceneContents& contents, uint32_t bits) {
  for (uint32_t b = 0; b < contentsBits; b++)
    if ((bits & contents.bits & (1u << b)) && contents.who[b]) return contents.who[b];
  return "a shader";
}

std::string reasonOf(const Choice& row, const SceneContents& contents) {
  std::string text;
  for (const char* c = row.reason; *c; c++)
    if (const bool subject = !std::strncmp(c, "{}", 2); subject || !std::strncmp(c, "[]", 2)) {
      text += firstOf(contents, subject ? row.all : row.any);
      c++;
    } else
      text += *c;
  return text;
}

// Paths from lamps are not scattered by media and do not know which media they start in, so worlds
// with fog are followed from the camera.
void avoidLightTracing(const SceneContents& contents, TransportChoice& choice) {
  if (!(contents.bits & hasFog) || !traitsOf(choice.transport).tracesLamps) return;
  choice.transport = RT_TRANSPORT_PATH;
  choice.reason =
      std::string(firstOf(contents, hasFog)) +
      " scatters or absorbs light inside, so paths start at the camera and not at lamps";
}

// Returns whether the environment emits light. It is evaluated on a coarse grid first. If that is
// black, the full table is built, because a light source may lie between the grid points.
bool shines(const RenderScene& scene, const RenderScene* before) {
  const ShaderSlot& environment = scene.environment.shader;
  if (!environment.shaderClass || !environment.shaderClass->miss) return false;
  if (before && before->skyKnown && before->textures == scene.textures &&
      before->environment.shader.params == environment.params &&
      before->environment.shader.shaderClass == environment.shaderClass)
    return before->skyShines;
  return SkySampler::shines(scene) || !SkySampler(scene).black();
}

// Returns whether light paths that start in the sun of the sky decide about the transport.
bool sunMatters(RenderScene& scene, const SceneContents& contents, const RenderScene* before) {
  constexpr uint32_t needed = hasMirrors | hasProjection;
  if (scene.frame.transport != RT_TRANSPORT_AUTO || (contents.bits & needed) != needed ||
      (contents.bits & hasStarts) || scene.frame.measure)
    return false;
  return scene.emitters->tabulateSky(scene, before).hasSun();
}

} // namespace

SceneContents contentsOf(RenderScene& scene, const RenderScene* before) {
  SceneContents c;
  const auto set = [&c](uint32_t bits, const char* name) {
    for (uint32_t b = 0; b < contentsBits; b++)
      if ((bits & ~c.bits) & (1u << b)) c.who[b] = name;
    c.bits |= bits;
  };
  const Record* last = nullptr;
  for (const Record& record : scene.records) {
    const bool values = record.parameterCount > 0;
    if (last && last->shader == record.shader && (last->parameterCount > 0) == values) continue;
    last = &record;
    const ShaderSlot& shader = (*scene.shaders)[record.shader];
    const RtsClass& shaderClass = *shader.shaderClass;
    if (!shaderClass.surface) continue; // the class has only `shade`, which every transport uses
    // Parameter values of a geometry may make a surface scatter although its shader's values do
    // not.
    const bool scatters = values || !(shader.traits & (RTS_NO_SCATTER | RTS_UNLIT));
    const bool emits = shader.traits & RTS_EMISSIVE;
    const bool mirrors = (shader.traits & RTS_SPECULAR) && !(shader.traits & RTS_MEDIUM_ONLY);
    uint32_t bits = mirrors ? uint32_t(hasMirrors) : 0u;
    if (fillsSpace(scene, shader))
      bits |= hasFog |
              (openrt::scatters(scene.shaders->media()[shader.medium - 1]) ? hasScattering : 0u);
    if (shaderClass.shade)
      bits |= (scatters ? hasShading : 0u) | (emits ? hasGlow : 0u);
    else
      bits |= hasLobes | (scatters ? hasScattering : 0u) | (emits ? hasEmitters : 0u);
    if (emits) bits |= hasStarts;
    if (shader.traits & RTS_GLOBAL) bits |= asksForAll;
    set(bits, shaderClass.name);
  }
  for (const LightSlot& lamp : scene.lights)
    set(hasLamps | (lamp.shader.shaderClass->extent ? hasStarts : 0u),
        lamp.shader.shaderClass->name);
  const RtsClass* camera = scene.camera.shader.shaderClass;
  if (scene.frame.measure == RT_MEASURE_ILLUMINANCE) {
    if (SensorPlane::of(scene)) set(hasProjection, "the sensor");
  } else if (camera && camera->project && !scene.frame.measure)
    set(hasProjection, camera->name);
  const ShaderSlot& environment = scene.environment.shader;
  const bool backdrop = environment.traits & RTS_BACKDROP;
  if (scene.frame.measure == RT_MEASURE_ILLUMINANCE) set(hasLobes | hasScattering, "the sensor");
  scene.skyKnown =
      environment.shaderClass && ((c.bits & hasScattering) || ((c.bits & hasShading) && !backdrop));
  scene.skyShines = scene.skyKnown && shines(scene, before);
  if (scene.skyShines) set(hasSky | (backdrop ? 0u : hasSkyLight), environment.shaderClass->name);
  if (scene.skyShines && sunMatters(scene, c, before))
    set(hasStarts, environment.shaderClass->name);
  return c;
}

TransportChoice chooseTransport(RenderScene& scene, const RenderScene* before) {
  const SceneContents contents = contentsOf(scene, before);
  TransportChoice choice;
  choice.transport = scene.frame.transport;
  // Light paths reach sensors that fill a plane. They bring means over the sensors' cells, not
  // readings at points, so they are followed only if the user has asked for them.
  const bool measures = scene.frame.measure != RT_MEASURE_NOTHING,
             reached = measures && (contents.bits & hasProjection);
  if (scene.transport.shaderClass) {
    if (!choice.transport) choice.transport = RT_TRANSPORT_PATH;
    choice.reason = std::string("the transport shader ") + scene.transport.shaderClass->name;
    return choice;
  }
  if (measures && (choice.transport == RT_TRANSPORT_AUTO ||
                   (traitsOf(choice.transport).tracesLamps && !reached))) {
    choice.transport = RT_TRANSPORT_PATH;
    choice.reason = "sensors follow paths";
  } else if (choice.transport != RT_TRANSPORT_AUTO) {
    choice.reason = "chosen by the user";
  } else {
    for (const Choice& row : choices) {
      if (row.from != choice.transport || !holds(contents.bits, row.all, row.any)) continue;
      choice.transport = row.to;
      choice.reason += reasonOf(row, contents);
    }
  }
  avoidLightTracing(contents, choice);
  const TransportTraits& traits = traitsOf(choice.transport);
  for (const Omission& row : omissions)
    if ((row.leaves & traits.omits) && holds(contents.bits, row.all, row.any))
      choice.leavesOut |= row.leaves;
  if (choice.leavesOut & RT_LEAVES_CAUSTICS) {
    const bool followed = traits.tracesLamps && (contents.bits & hasProjection);
    for (const LightSlot& lamp : scene.lights)
      choice.unreached += !followed || !lamp.shader.shaderClass->extent;
  }
  return choice;
}

} // namespace openrt
