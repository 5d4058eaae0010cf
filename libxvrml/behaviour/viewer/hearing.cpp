// hearing.cpp: computes what the viewer of a running world hears: its Sounds (clause 6.42) and
// their directions, for xvrml/media.h. [the browser's thread]
#include <algorithm>
#include <cmath>
#include <utility>

#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"
#include "xvrml/browser.h"
#include "xvrml/media.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

std::vector<Node*> soundsBelow(const Scope& scope) {
  std::vector<Node*> found;
  walk(rootsOf(scope), [&](Node& node, std::vector<Node*>& open) {
    if (node.type().index == nodes::Sound::typeIndex) found.push_back(&node);
    childrenInScene(node, open);
  });
  return found;
}

Vec3f narrow(const Vector& v) { return {float(v.x), float(v.y), float(v.z)}; }

// Returns the factor that a clip brings of its own (ISO/IEC 19775-1:2023 16.4.1). Beyond a limit
// every sample is as loud as a device can play it, so that sums stay finite.
double gainOf(const Node* source) {
  constexpr double most = 1000;
  const auto* clip = source->type().index == nodes::AudioClip::typeIndex
                         ? static_cast<const nodes::AudioClip*>(source)
                         : nullptr;
  return clip && std::isfinite(clip->gain) ? std::clamp(double(clip->gain), -most, most) : 1;
}

} // namespace

std::vector<Heard> heardIn(Browser& browser) {
  constexpr size_t places = 16; // places of one Sound that count
  Interaction& interaction = interactionOf(browser.events());
  const uint64_t structure = interaction.engine.structure();
  if (std::exchange(interaction.soundsStructure, structure) != structure)
    interaction.sounds = soundsBelow(browser.world().scope);
  std::vector<Heard> heard;
  Matrix toViewer;
  const Matrix view = interaction.viewer.view();
  if (interaction.sounds.empty() || !invert(view, toViewer)) return heard;
  for (Node* node : interaction.sounds) {
    const auto& sound = *nodeCast<nodes::Sound>(node);
    const Node* source = renderedNode(sound.source.get());
    if (!source) continue;
    const Playing playing = playingOf(*source);
    if (!playing.clip) continue;
    for (const Path& path : pathsTo(*node, places)) {
      const Matrix toWorld = localToWorld(path);
      Matrix toLocal;
      if (!isChosen(path) || !invert(toWorld, toLocal)) continue;
      const Vector eye = transformPoint(toLocal, transformPoint(view, Vector(0)));
      const Vector place =
          transformPoint(toViewer, transformPoint(toWorld, vector(sound.location)));
      SoundLevels levels = soundLevels(sound, narrow(eye), narrow(place));
      const double gain = gainOf(source);
      heard.push_back({node, playing, {levels.left * gain, levels.right * gain}});
    }
  }
  return heard;
}

} // namespace xvrml
