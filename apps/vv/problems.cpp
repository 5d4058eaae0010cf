// problems.cpp: see problems.h.
#include "problems.h"

#include <utility>

#include <fmt/format.h>

#include "messages.h"

namespace vv {

void Problems::tell(const xvrml::World& world) {
  constexpr size_t messagesShown = 50;
  if (std::exchange(world_, &world) != &world) told_ = droppedTold_ = 0;
  xvrml::Diagnostics fresh;
  const auto& list = world.diagnostics.list();
  for (; told_ < list.size(); ++told_) fresh.add(list[told_]);
  sayDiagnostics(fresh, options_.verbose || options_.check ? 0 : messagesShown, options_.quiet);
  if (const uint64_t dropped = world.diagnostics.dropped(); dropped > droppedTold_) {
    say(fmt::format("vv: and {} more problems", dropped - droppedTold_));
    droppedTold_ = dropped;
  }
}

} // namespace vv
