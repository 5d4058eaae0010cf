// transport.cpp: see transport.h.
#include "render/transport.h"

#include "render/render_scene.h"

namespace openrt {
namespace {

struct Wish {
  RTenum transport = RT_TRANSPORT_DIRECT;
  const char* why = "no surface asks for more than the lights";
};

// An emitter that also has an answer of its own (`shade`) is a picture of light rather than light.
Wish wishOf(const ShaderSlot& shader) {
  const RtsClass& c = *shader.shaderClass;
  if (shader.traits & RTS_GLOBAL) return {RT_TRANSPORT_PATH, "asks for the light of other surfaces"};
  if (!c.surface || c.shade) return {};
  if (shader.traits & RTS_EMISSIVE) return {RT_TRANSPORT_PATH, "sends out light"};
  if (shader.traits & RTS_GLOSSY) return {RT_TRANSPORT_PATH, "scatters light into a cone"};
  return {RT_TRANSPORT_WHITTED, shader.traits & RTS_SPECULAR ? "mirrors or refracts" : "answers in lobes"};
}

} // namespace

TransportChoice chooseTransport(const RenderScene& scene) {
  if (scene.transport.shaderClass)
    return {scene.frame.transport ? RTenum(scene.frame.transport) : RTenum(RT_TRANSPORT_PATH),
            std::string("the transport shader ") + scene.transport.shaderClass->name};
  if (scene.frame.transport != RT_TRANSPORT_AUTO) return {scene.frame.transport, "asked for"};
  Wish strongest;
  const char* who = nullptr;
  uint32_t last = ~0u;
  for (const Record& record : scene.records) {
    if (record.shader == last) continue;
    last = record.shader;
    const Wish wish = wishOf((*scene.shaders)[last]);
    if (wish.transport <= strongest.transport) continue;
    strongest = wish, who = (*scene.shaders)[last].shaderClass->name;
    if (wish.transport == RT_TRANSPORT_PATH) break;
  }
  return {strongest.transport, who ? std::string("a surface of class ") + who + " " + strongest.why : strongest.why};
}

} // namespace openrt
