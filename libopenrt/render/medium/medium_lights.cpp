#include "render/medium/medium_lights.h"

#include <algorithm>

#include "render/surface/media.h"
#include "scene/transports.h"

namespace openrt {
namespace {

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

std::vector<MediumLights> findMediumLights(const RenderScene& scene) {
  const std::span<const RtsMedium> media = scene.shaders->media();
  std::vector<MediumLights> lights;
  if (!tracesPaths(scene.frame.transport) || std::none_of(media.begin(), media.end(), scatters))
    return lights;
  lights.resize(media.size());
  std::vector<bool> known(media.size());
  bool any = false;
  for (const Record& record : scene.records) {
    const uint16_t medium = (*scene.shaders)[record.shader].medium;
    if (!medium || known[medium - 1]) continue;
    known[medium - 1] = true;
    if (!scatters(media[medium - 1])) continue;
    any = true;
    MediumLights& found = lights[medium - 1];
    found.set = scene.buckets[record.bucket].lightSet;
    found.lamps = lampsOf(scene, found.set);
  }
  if (!any) lights.clear();
  return lights;
}

} // namespace openrt
