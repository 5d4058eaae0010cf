// particle_system.cpp: the time of a ParticleSystem (ISO/IEC 19775-1 40.4.5): when particles are
// born, and isActive. An event counts from its own time, so that pictures do not depend on when
// others were made.
#include <utility>

#include <fmt/format.h>

#include "base/budget.h"
#include "behaviour/builtin.h"
#include "behaviour/media.h"
#include "behaviour/named_fields.h"
#include "behaviour/particles/drawn.h"
#include "behaviour/particles/form.h"
#include "behaviour/particles/life.h"
#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"

namespace xvrml {
namespace {

// Memory for one system is bounded: beyond this, the oldest emission is forgotten.
constexpr size_t mostEmissions = 64;

struct State : NodeState {
  double began = 0;      // time at which the system became part of the world
  bool sent = false;     // the last isActive
  bool emits = false;    // particles are being born
  uint64_t emission = 0; // number of the last one
  bool warned = false;   // it has been said that there are fewer than maxParticles
  Share share;           // memory that the particles take of the world's budget
};

State& stateOf(Events& events, Node& node) { return static_cast<State&>(*events.state(node)); }

bool isOn(const Node* emitter) {
  const FieldInfo* const on = emitter ? fieldNamed<"on">(*emitter) : nullptr;
  return on && std::get<SFBool>(emitter->get(*on));
}

// A system without an emitter is never active.
bool isActive(const nodes::ParticleSystem& system) {
  return system.enabled && system.maxParticles > 0 && renderedNode(system.emitter.get());
}

bool emits(const nodes::ParticleSystem& system) {
  return isActive(system) && system.createParticles && isOn(renderedNode(system.emitter.get()));
}

// Reserves memory for the particles, and says once if there are fewer than maxParticles.
void reserve(Events& events, TimedParticleSystem& system, State& state) {
  ParticleRoom room = roomOf(system);
  state.share.clear();
  while (room.count > 0 && !state.share.take(room.count * room.bytes)) {
    room.count /= 2;
    room.limit = state.share.budget()->name();
  }
  system.clock.most = room.count;
  if (room.limit.empty() || std::exchange(state.warned, true)) return;
  events.diagnostics().warn(system.source,
                            fmt::format("ParticleSystem: maxParticles is {}, and {} are drawn: {}",
                                        system.maxParticles, room.count, room.limit));
}

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  auto* const system = dynamic_cast<TimedParticleSystem*>(&node);
  if (!system) return nullptr; // a program has made it of another class
  auto state = std::make_unique<State>();
  state->began = events.now();
  state->share = mediaShare(events);
  state->emits = emits(*system);
  system->clock = {};
  if (!state->emits) system->clock.emissions.clear();
  if (!isKnownForm(system->geometryType))
    events.diagnostics().warn(
        node.source, fmt::format("ParticleSystem: geometryType \"{}\" is not known, expected QUAD, "
                                 "SPRITE, TRIANGLE, LINE, POINT or GEOMETRY; QUAD is used",
                                 system->geometryType));
  reserve(events, *system, *state);
  events.wantTicks(node, true);
  events.wantLooks(node, true);
  Engine::of(events).outdateFigures(); // it has been expanded without its clock
  return state;
}

// Begins or ends an emission if something has turned it on or off.
void followEvents(TimedParticleSystem& system, State& state, double now) {
  std::vector<Emission>& emissions = system.clock.emissions;
  if (!isActive(system)) {
    emissions.clear();
    state.emits = false;
  }
  if (emits(system) == state.emits) return;
  state.emits = !state.emits;
  if (!state.emits) {
    emissions.back().until = now;
    return;
  }
  const double phase =
      emissions.empty() ? 0 : phaseAfter(emissions.back(), system.particleLifetime);
  if (emissions.size() == mostEmissions) emissions.erase(emissions.begin());
  emissions.push_back({now, std::numeric_limits<double>::infinity(), ++state.emission, phase});
}

// Turns SPRITEs to the viewer. One at several places is turned as at the first of them. Returns
// whether they stand in another way than before.
bool faceViewer(Events& events, TimedParticleSystem& system) {
  const std::vector<Path> paths = pathsTo(system, 1);
  const Matrix view = interactionOf(events).viewer.view();
  Matrix toLocal;
  if (paths.empty() || !invert(Picker::toWorld(paths[0], view), toLocal)) return false;
  const Matrix local = rigid(compose(toLocal, view));
  const auto axis = [&](int i) {
    return Vec3f{float(local.x[i][0]), float(local.x[i][1]), float(local.x[i][2])};
  };
  const auto before = std::pair(system.clock.right, system.clock.up);
  system.clock.right = axis(0);
  system.clock.up = axis(1);
  return before != std::pair(system.clock.right, system.clock.up);
}

void sendActivity(Events& events, TimedParticleSystem& system) {
  State& state = stateOf(events, system);
  const FieldInfo& out = *fieldNamed<"isActive">(system);
  const bool active = isActive(system);
  if (state.sent == active || events.hasSent(system, out)) return;
  state.sent = active;
  events.send(system, out, active);
}

void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  if (!events.state(node)) return;
  auto& system = static_cast<TimedParticleSystem&>(node);
  State& state = stateOf(events, node);
  if (isField<"maxParticles">(node, in) || isField<"geometry">(node, in))
    reserve(events, system, state);
  followEvents(system, state, events.now() - state.began);
  sendActivity(events, system);
}

// Brings the clock to the present. The engine moves the particles when the cascade has settled.
void tick(Events& events, Node& node) {
  if (!events.state(node)) return;
  auto& system = static_cast<TimedParticleSystem&>(node);
  const double now = events.now() - stateOf(events, node).began;
  if (std::exchange(system.clock.now, now) != now) Engine::of(events).outdateFigures();
  sendActivity(events, system);
}

// Called after the events of each tick, so that those of the emitter have arrived.
void look(Events& events, Node& node) {
  if (!events.state(node)) return;
  auto& system = static_cast<TimedParticleSystem&>(node);
  State& state = stateOf(events, node);
  const bool emitted = state.emits;
  followEvents(system, state, events.now() - state.began);
  const bool turned = system.geometryType == "SPRITE" && faceViewer(events, system);
  if (turned || state.emits != emitted) Engine::of(events).outdateFigures();
}

} // namespace

void addParticleBehaviours(const AddBehaviour& add) {
  add(nodes::ParticleSystem::nodeType(),
      {.begin = begin, .receive = receive, .tick = tick, .look = look});
}

} // namespace xvrml
