// rules_scene.cpp: rules about the contents of the scene and what can be seen of them. Application
// thread.
#include <set>

#include "backend/debug/rules.h"
#include "openrt/openrt.h"

namespace openrt::debug {
namespace {

void noCamera(const RuleContext& f, const Report& report) {
  if (f.scene.camera.shader == 0 || !f.scene.shaders.contains(f.scene.camera.shader))
    report(0, "the frame has no camera and shows nothing: call rtPerspective, rtOrtho or "
              "rtUseCamera before rtRender");
}

void channels(const RuleContext& f, const Report& report) {
  const edit::FrameSettingsT& frame = f.scene.frame;
  if ((frame.channels & RT_VARIANCE) && frame.samples == 1)
    report(RT_VARIANCE, "RT_VARIANCE of one sample a pixel is 0 everywhere: raise "
                        "RT_SAMPLES_PER_PIXEL or leave the channel out");
  if ((frame.channels & (RT_ERROR | RT_TRUST)) && frame.samples < 32 && frame.replicates == 0)
    report(RT_ERROR,
           "RT_ERROR and RT_TRUST of " + std::to_string(frame.samples) +
               " samples a pixel are never trusted: at least 32 are needed (RT_SAMPLES_PER_PIXEL)");
  if ((frame.channels & ~uint32_t(RT_SAMPLES)) == 0)
    report(RT_SAMPLES,
           "the frame has only the channel RT_SAMPLES, so no picture can be read: add RT_RGBA");
}

bool drawable(const Scene& scene, uint32_t id) {
  const auto object = scene.objects.find(id);
  return (object != scene.objects.end() && !object->second.geometries.empty()) ||
         !scene.childrenOf(id).empty();
}

void emptyInstances(const RuleContext& f, const Report& report) {
  for (const auto& [id, instance] : f.scene.instances)
    if (!drawable(f.scene, instance.object))
      report(id,
             nameOf("instance", id) + " stands for " + nameOf("object", instance.object) +
                 ", which is empty: define it between rtBeginObject and rtEndObject; geometry "
                 "whose primitives are all degenerate is dropped (RTstats.rejected.primitives)");
}

void flatInstances(const RuleContext& f, const Report& report) {
  for (const auto& [id, instance] : f.scene.instances)
    if (!instance.matrix.usable())
      report(id, "the matrix of " + nameOf("instance", id) +
                     " is singular or out of range, so it is not drawn: to hide it use "
                     "rtInstanceVisible, else check its scale factors");
}

void neverPlaced(const RuleContext& f, const Report& report) {
  std::set<uint32_t>& placed = f.memory.placed;
  for (const auto& [id, instance] : f.scene.instances) placed.insert(instance.object);
  for (const auto& [id, object] : f.scene.objects)
    if (!object.geometries.empty() && !placed.contains(id))
      report(id, nameOf("object", id) + " is defined but not placed in the scene: place it with "
                                        "rtInstantiateObject, or delete it");
}

void redefined(const RuleContext& f, const Report& report) {
  constexpr uint64_t often = 4;
  for (const auto& [id, history] : f.histories)
    if (history.definitions >= often && !history.hinted)
      report(
          id,
          nameOf("object", id) + " was defined " + std::to_string(history.definitions) +
              " times: call rtObjectHint(object, RT_DYNAMIC) before its first definition, so that "
              "the first redefinition does not rebuild the scene; to move it use rtInstanceMatrix");
}

constexpr Rule table[] = {
    {"no-camera", noCamera},
    {"channels", channels},
    {"empty-instance", emptyInstances},
    {"singular-matrix", flatInstances},
    {"never-placed", neverPlaced},
    {"redefined", redefined},
};

} // namespace

std::span<const Rule> sceneRules() { return table; }

std::string nameOf(const char* kind, uint32_t id) {
  return std::string(kind) + " " + std::to_string(id);
}

std::string nameOfShader(const RuleContext& facts, uint32_t id) {
  const RtsClass* table = facts.classOf(id);
  return nameOf("shader", id) + (table ? std::string(" (") + table->name + ")" : std::string());
}

} // namespace openrt::debug
