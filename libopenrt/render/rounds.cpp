// rounds.cpp: see rounds.h. Which samples a picture is made of depends on the settings and on pilots alone, with a time limit
// also on the time; never on who renders what.
#include "render/rounds.h"

#include <algorithm>
#include <bit>

#include "render/error.h"
#include "render/tile.h"

namespace openrt {

namespace {
constexpr uint32_t mostOfRound = TileRenderer::largestWave; // progressive: so that the picture goes on becoming better everywhere
}

std::unique_ptr<Rounds> Rounds::of(const edit::FrameSettingsT& frame, uint32_t tiles, bool light, double now) {
  const bool wanted =
      frame.timeLimit > 0 ? frame.samples > 1 : frame.progressive && frame.samples >= TileRenderer::fewestOfRounds;
  return wanted && tiles > 0 ? std::make_unique<Rounds>(frame, tiles, light, now) : nullptr;
}

Rounds::Rounds(const edit::FrameSettingsT& frame, uint32_t tiles, bool light, double now)
    : frame_(frame), light_(light), timed_(frame.timeLimit > 0), pilot_(timed_ || TileRenderer::needsPilot(frame)), kept_(tiles),
      wanted_(tiles, frame.samples), most_(frame.samples), started_(now), began_(now) {
  if (timed_ && frame.targetError > 0) samples_ = std::min(TileRenderer::pilotSamples, frame.samples);
  all_ = uint64_t(tiles) * (frame.samples + (pilot_ ? TileRenderer::pilotSamples : 0));
}

Replicates Rounds::replicates(uint32_t number) const {
  return timed_ ? replicates_ : replicatesOf(frame_, wanted_[number], frame_.seed);
}

void Rounds::render(TileRenderer& renderer, const Tile& tile, uint32_t number, Ledger& ledger) {
  std::vector<std::byte>& kept = kept_[number];
  uint32_t& wanted = wanted_[number];
  if (pilot_ && timed_) {
    wanted = renderer.pilot(tile, samples_);
  } else if (pilot_) {
    const uint32_t needed = renderer.pilotRound(tile, kept, first_, samples_);
    if (first_ + samples_ < TileRenderer::pilotSamples) return void(done_ += samples_);
    wanted = needed;
    done_ += samples_, all_ -= frame_.samples - wanted;
  } else {
    const uint32_t until = std::min(first_ + samples_, wanted);
    const bool again = !timed_ && light_; // in the last round, with all of the light
    const bool lastRound = first_ + samples_ >= most_;
    if (until <= first_ && !(again && lastRound)) return;
    const uint32_t samples = until - std::min(first_, until);
    renderer.renderRound(tile, kept, replicates(number), first_, samples, !timed_ && until >= wanted && (!again || lastRound));
    ledger.add(renderer.ledger());
    done_ += samples;
  }
}

bool Rounds::endRound(double now) {
  const bool more = timed_ ? endTimed(now) : endProgressive();
  over_ = !more;
  return more;
}

// Whether there is a further round depends on the time alone and on the pilot, which is no part of the picture.
bool Rounds::endTimed(double now) {
  const double took = now - began_, left = double(frame_.timeLimit) - (now - started_);
  bool more = true;
  if (pilot_) {
    // About sixteen rounds fill the time that is left.
    const double samples = left / 16 / std::max(took, 1e-9) * samples_;
    const uint32_t most = std::max(frame_.samples / 16, 1u);
    replicates_ = {frame_.seed, uint32_t(std::bit_width(uint32_t(std::clamp(samples, 1.0, double(most))))) - 1};
    most_ = *std::max_element(wanted_.begin(), wanted_.end());
    pilot_ = false;
  } else {
    first_ += samples_;
    more = left >= took / 2; // else the next one would end farther beyond the limit than this one has ended before it
  }
  samples_ = std::min(replicates_.size(), frame_.samples - std::min(first_, frame_.samples));
  began_ = now;
  return more && first_ < most_;
}

// The portions are those of the waves, so that a wave holds the same paths in one go and in rounds.
bool Rounds::endProgressive() {
  first_ += samples_;
  if (pilot_ && first_ >= TileRenderer::pilotSamples) {
    most_ = *std::max_element(wanted_.begin(), wanted_.end());
    pilot_ = false;
    first_ = 0;
    samples_ = TileRenderer::pilotSamples; // fewer would look worse than the pilot
  } else
    samples_ = std::clamp(first_, 1u, mostOfRound);
  const uint32_t all = pilot_ ? TileRenderer::pilotSamples : most_;
  samples_ = std::min(samples_, all - std::min(first_, all));
  return first_ < most_;
}

double Rounds::lightShare() const {
  const uint32_t all = pilot_ ? TileRenderer::pilotSamples : most_; // what the pilot finds depends on all of the light
  return timed_ || first_ + samples_ >= all ? 1.0 : double(first_) / most_;
}

float Rounds::progress(double now) const {
  if (over_) return 1;
  const double done = timed_ ? (now - started_) / double(frame_.timeLimit) : double(done_) / double(all_);
  return std::min(float(done), 0.99f);
}

} // namespace openrt
