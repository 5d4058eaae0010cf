#include "render/surface/sample_lobes.h"

namespace openrt {

LobeSampling drawChoices(const RtsBatch& batch, const RandomNumbers& random) {
  LobeSampling sampling{.random = random};
  if (batch.lobes.size() == 1 && nonSpecularFunctions(batch.lobes[0])) {
    // Each hit has at most one sample, so no choice depends on the first numbers.
    sampling.choices[0] = batch.arena.takeZero<float>(padded(random.count));
    sampling.choices[1] = random.drawSecond(Decision::choice, batch.arena);
  } else {
    random.draw(Decision::choice, batch.arena, sampling.choices);
  }
  return sampling;
}

void sampleLobes(const RtsBatch& batch, LobeSampling& sampling) {
  Arena& arena = batch.arena;
  const RtsHits& hits = batch.points->hits;
  for (uint32_t l = 0; l < batch.lobes.size(); l++) {
    if (!nonSpecularFunctions(batch.lobes[l])) continue;
    auto* samples = new (arena.take<LobeSamples>(1)) LobeSamples(arena, hits.count, &batch);
    sampling.samples[l] = samples;
    ArenaScope scope(arena);
    float* square[2];
    sampling.random.draw(Decision::direction, arena, square, pairOfLobe(l));
    samples->sample(batch.lobes[l], hits, hits.count, arena.takeNumbers(hits.count), square);
  }
}

void allocateSelection(const RtsBatch& batch, LobeSampling& sampling) {
  for (uint32_t l = 0; l < batch.lobes.size(); l++)
    if (sampling.samples[l])
      sampling.selectionProbability[l] =
          batch.arena.takeZero<float>(padded(batch.points->hits.count));
}

} // namespace openrt
