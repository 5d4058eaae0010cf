#include "render/medium/medium_lights.h"

#include <algorithm>
#include <iterator>

#include "render/lights/light_sampler.h"
#include "render/media.h"
#include "scene/transports.h"

namespace openrt {
namespace {

bool absorbs(const RtsMedium& medium) {
  return std::any_of(std::begin(medium.absorption), std::end(medium.absorption),
                     [](float a) { return a != 0; });
}

// Returns the positions of the lights of a set; none if more than `LightSampler::few` have one.
std::vector<Vec3f> lampsOf(const RenderScene& scene, uint32_t set) {
  std::vector<Vec3f> lamps;
  for (const uint32_t light : scene.lightSets[set]) {
    const LightSlot& slot = scene.lights[light];
    const RtsClass& c = *slot.shader.shaderClass;
    RtsExtent extent{};
    if (!c.extent || !c.extent(&scene.host, slot.shader.params, &extent) || extent.parallel)
      continue;
    const Vec3f place = slot.fromLocal.point(vectorOf(extent.position));
    if (isFinite(place)) lamps.push_back(place);
  }
  if (lamps.size() > LightSampler::few) lamps.clear();
  return lamps;
}

} // namespace

bool fillsSpace(const RenderScene& scene, const ShaderSlot& shader) {
  if (!shader.medium) return false;
  const RtsMedium& medium = scene.shaders->media()[shader.medium - 1];
  return scatters(medium) || ((shader.traits & RTS_MEDIUM_ONLY) && absorbs(medium));
}

bool hasAbsorption(const RenderScene& scene) {
  const std::span<const RtsMedium> media = scene.shaders->media();
  return std::any_of(media.begin(), media.end(), absorbs);
}

std::vector<MediumLights> findMediumLights(const RenderScene& scene) {
  const std::span<const RtsMedium> media = scene.shaders->media();
  std::vector<MediumLights> lights;
  if (media.empty() || !tracesPaths(scene.frame.transport)) return lights;
  lights.resize(media.size());
  std::vector<bool> known(media.size());
  bool any = false;
  for (const Record& record : scene.records) {
    const ShaderSlot& shader = (*scene.shaders)[record.shader];
    const uint16_t medium = shader.medium;
    if (!medium) continue;
    any |= fillsSpace(scene, shader);
    if (known[medium - 1]) continue;
    known[medium - 1] = true;
    if (!scatters(media[medium - 1])) continue;
    MediumLights& found = lights[medium - 1];
    found.set = scene.buckets[record.bucket].lightSet;
    found.lamps = lampsOf(scene, found.set);
  }
  if (!any) lights.clear();
  return lights;
}

} // namespace openrt
