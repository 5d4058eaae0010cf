// behaviours.cpp: behaviours by node type index.
#include <deque>

#include "behaviour/builtin.h"

namespace xvrml {
namespace {

std::deque<Behaviour>& table() {
  static std::deque<Behaviour> behaviours = [] {
    std::deque<Behaviour> t;
    addBuiltinBehaviours([&](const NodeType& type, const Behaviour& behaviour) {
      if (size_t(type.index) >= t.size()) t.resize(size_t(type.index) + 1);
      t[size_t(type.index)] = behaviour;
    });
    return t;
  }();
  return behaviours;
}

bool behaves(const Behaviour& b) { return b.begin || b.accept || b.receive || b.tick || b.look; }

} // namespace

void setBehaviour(const NodeType& type, const Behaviour& behaviour) {
  if (type.index < 0) return;
  if (size_t(type.index) >= table().size()) table().resize(size_t(type.index) + 1);
  table()[size_t(type.index)] = behaviour;
}

const Behaviour* behaviourOf(const NodeType& type) {
  const std::deque<Behaviour>& t = table();
  if (type.index < 0 || size_t(type.index) >= t.size()) return nullptr;
  return behaves(t[size_t(type.index)]) ? &t[size_t(type.index)] : nullptr;
}

} // namespace xvrml
