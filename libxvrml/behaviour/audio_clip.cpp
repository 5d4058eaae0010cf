// audio_clip.cpp: AudioClip (clause 6.4): sends duration_changed and isActive, and provides the
// samples for xvrml/media.h.
#include <exception>
#include <stdexcept>

#include "behaviour/media.h"
#include "behaviour/sound_file.h"
#include "event/live.h"

namespace xvrml {
namespace {

struct State : Media {
  double load(Events& events, Node& node) override {
    clip = nullptr;
    path.clear();
    share = mediaShare(events);
    limits = loadOptions(events).limits;
    diagnostics = &events.diagnostics();
    double seconds = -1;
    readFirst(events, node, static_cast<nodes::AudioClip&>(node).url, [&](const std::string& file) {
      seconds = soundLength(file, room());
      path = file;
      return true;
    });
    return seconds;
  }
  TimeFields fields(const Node& node) const override {
    const auto& n = static_cast<const nodes::AudioClip&>(node);
    return {n.startTime, n.stopTime, duration > 0 && n.pitch > 0 ? duration / n.pitch : 0,
            n.loop,      true,       n.pauseTime,
            n.resumeTime};
  }
  void play(Events&, Node&, const TimeStep& step) override { position = step.fraction * duration; }

  ImageRoom room() const { return {limits, ~uint64_t(0), share.budget().get()}; }

  Limits limits;
  std::string path; // empty: no file could be read
  std::shared_ptr<const Clip> clip;
  double position = 0; // playing position in seconds
  Share share;         // share of the world's budget for the samples
  Diagnostics* diagnostics = nullptr;
};

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  return beginMedia(events, node, std::make_unique<State>());
}

} // namespace

Playing playingOf(const Node& node) {
  if (node.type().index != nodes::AudioClip::typeIndex || !node.live || !liveOf(node)->part)
    return {};
  auto* state = static_cast<State*>(liveOf(node)->part->state.get());
  if (!state || !state->time.active() || state->time.paused() || state->path.empty()) return {};
  if (!state->clip) {
    try {
      state->clip =
          std::make_shared<Clip>(readSound(state->path, state->room(), [&](uint64_t bytes) {
            if (!state->share.take(bytes))
              throw std::runtime_error(overBudgetMessage(bytes, *state->share.budget()));
          }));
    } catch (const std::exception& failure) {
      state->diagnostics->warn(node.source, "AudioClip: no sound: " + std::string(failure.what()));
      state->path.clear(); // the clip's events continue
      return {};
    }
  }
  const auto& clip = static_cast<const nodes::AudioClip&>(node);
  return {state->clip, state->position, clip.pitch, clip.loop};
}

void addAudioClipBehaviours(const AddBehaviour& add) {
  addMedia(add, nodes::AudioClip::nodeType(), begin);
}

} // namespace xvrml
