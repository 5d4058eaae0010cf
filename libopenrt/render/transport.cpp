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
  Wish strongest;
  const char* who = nullptr;
  bool specular = false, lamps = false;
  uint32_t last = ~0u;
  for (const Record& record : scene.records) {
    if (record.shader == last) continue;
    last = record.shader;
    const ShaderSlot& shader = (*scene.shaders)[last];
    specular |= shader.traits & RTS_SPECULAR, lamps |= shader.traits & RTS_EMISSIVE;
    const Wish wish = wishOf(shader);
    if (wish.transport <= strongest.transport) continue;
    strongest = wish, who = shader.shaderClass->name;
  }
  uint32_t followed = 0; // lights that paths can begin at
  for (const LightSlot& light : scene.lights) followed += light.shader.shaderClass->extent != nullptr;
  const RtsClass* camera = scene.camera.shader.shaderClass;
  const bool followable = specular && (lamps || followed) && camera && camera->project;

  TransportChoice choice;
  if (scene.transport.shaderClass) {
    choice.transport = scene.frame.transport ? RTenum(scene.frame.transport) : RTenum(RT_TRANSPORT_PATH);
    choice.reason = std::string("the transport shader ") + scene.transport.shaderClass->name;
  } else if (scene.frame.transport != RT_TRANSPORT_AUTO) {
    choice.transport = scene.frame.transport, choice.reason = "asked for";
  } else {
    choice.transport = strongest.transport;
    choice.reason = who ? std::string("a surface of class ") + who + " " + strongest.why : strongest.why;
    if (choice.transport == RT_TRANSPORT_PATH && followable) {
      choice.transport = RT_TRANSPORT_LIGHT;
      choice.reason += ", and there are mirrors or glass";
    }
  }
  const auto lights = uint32_t(scene.lights.size());
  if (specular && choice.transport == RT_TRANSPORT_PATH) choice.unreached = lights;
  if (specular && choice.transport == RT_TRANSPORT_LIGHT) choice.unreached = followable ? lights - followed : lights;
  return choice;
}

} // namespace openrt
