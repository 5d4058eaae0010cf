#include "render/path/image_leads.h"

#include "render/surface/sample_arrays.h"
#include "scene/transports.h"

namespace openrt {
namespace {

float mean(const Vec3f& v) { return (v.x + v.y + v.z) / 3; }

// Returns whether a rough lobe is narrow enough at a hit to show images.
bool isNarrow(const RtsLobe& lobe, uint32_t i) {
  if (lobe.kind == RTS_LOBE_GLOSSY) return lobe.parameter[0][i] <= ImageLead::nearlySmooth;
  return lobe.kind == RTS_LOBE_ROUGH_DIELECTRIC && lobe.parameter[1][i] <= ImageLead::nearlySmooth;
}

// The specular samples of the hits of a batch. Narrow rough lobes are taken for smooth ones.
class ImageSamples {
 public:
  ImageSamples(const RtsBatch& batch, const Boundaries& boundaries)
      : batch_(batch), follows_(followsImages(batch.scene.frame.transport)), smooth_(makeSmooth()),
        samples_(smooth_, {}, boundaries, TransportMode::importance, !follows_) {}
  ImageLead leadAt(uint32_t i) const;

 private:
  RtsBatch makeSmooth();
  // Returns whether a lobe shows an image at hit i.
  bool showsImage(const RtsLobe& lobe, uint32_t i) const {
    if (lobe.kind == RTS_LOBE_TRANSPARENT || !follows_) return lobe.kind == RTS_LOBE_TRANSPARENT;
    return !nonSpecularFunctions(lobe) || isNarrow(lobe, i);
  }

  const RtsBatch& batch_;
  const bool follows_;
  // By lobe and hit: Fresnel reflectance of a narrow glossy lobe in the direction of its mirror
  // image; null: 1.
  const float* reflectance_[RTS_MAX_LOBES] = {};
  const RtsBatch smooth_;
  // The weights are those of a path from a lamp, which do not change where light enters a denser
  // medium.
  const BsdfSampleArrays samples_;
};

// Returns the batch with smooth lobes instead of the rough ones that are narrow at some hits.
RtsBatch ImageSamples::makeSmooth() {
  RtsBatch smooth = batch_;
  const RtsHits& hits = batch_.points->hits;
  for (uint32_t l = 0; follows_ && l < smooth.lobes.size(); l++) {
    const RtsLobe& rough = batch_.lobes[l];
    bool narrow = false;
    for (uint32_t i = 0; i < hits.count && !narrow; i++) narrow = isNarrow(rough, i);
    if (!narrow) continue;
    const bool glossy = rough.kind == RTS_LOBE_GLOSSY;
    smooth.lobes[l].kind = glossy ? RTS_LOBE_REFLECTION : RTS_LOBE_DIELECTRIC;
    if (!glossy) continue;
    auto* share = batch_.arena.take<float>(padded(hits.count));
    expectGlossy(hits, rough, share);
    reflectance_[l] = share;
  }
  return smooth;
}

ImageLead ImageSamples::leadAt(uint32_t i) const {
  const Vec3f g = load(batch_.points->hits.geometric, i);
  float others = 0;
  for (const RtsLobe& lobe : batch_.lobes)
    if (Vec3f weight; weightAt(lobe, i, weight) && !showsImage(lobe, i)) others += mean(weight);
  Vec3f sum[2]; // the sums of transmission and reflection
  const SampleArrays* heaviest[2] = {};
  float most[2] = {};
  for (const SampleArrays& sample : samples_) {
    const auto l = size_t(sample.lobe - smooth_.lobes.begin());
    Vec3f weight = sample.weightAt(i);
    if (!showsImage(batch_.lobes[uint32_t(l)], i) || !(largest(weight) > 0)) continue;
    if (reflectance_[l]) weight *= reflectance_[l][i];
    const bool reflected = sample.deflected && dot(load(sample.direction, i), g) > 0;
    sum[reflected] += weight;
    if (heaviest[reflected] && !(mean(weight) > most[reflected])) continue;
    heaviest[reflected] = &sample;
    most[reflected] = mean(weight);
  }
  ImageLead lead;
  lead.reflected = mean(sum[1]) > mean(sum[0]);
  const float images = mean(sum[0]) + mean(sum[1]),
              least = lead.reflected ? ImageLead::leastReflection : ImageLead::leastTransmission;
  if (!(images > 0 && images >= least * (images + others))) return lead;
  lead.tint = sum[lead.reflected];
  lead.direction = load(heaviest[lead.reflected]->direction, i);
  lead.straight = !heaviest[lead.reflected]->deflected;
  lead.found = isFinite(lead.direction) && isFinite(lead.tint);
  return lead;
}

} // namespace

const ImageLead* findImageLeads(const RtsBatch& batch, const Boundaries& boundaries) {
  const uint32_t n = batch.points->hits.count;
  auto* leads = batch.arena.take<ImageLead>(n);
  ArenaScope scope(batch.arena);
  const ImageSamples samples(batch, boundaries);
  for (uint32_t i = 0; i < n; i++) leads[i] = samples.leadAt(i);
  return leads;
}

} // namespace openrt
