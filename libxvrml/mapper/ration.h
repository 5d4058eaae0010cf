// ration.h: what one part of the mapper draws from the budget of its world (base/budget.h), and the
// one message when there is nothing left. On the mapper's thread.
#pragma once

#include "base/budget.h"
#include "mapper/graph/cost.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

class Ration {
 public:
  // what: the things that are left out, for the message: "lights".
  Ration(World& world, const char* what) : world_(world), what_(what), share_(budgetOf(world)) {}

  // Takes bytes for something at `where`. False, after one message in the life of this object, if
  // there are not enough left.
  bool take(uint64_t bytes, const SourcePosition& where) {
    if (share_.take(bytes)) return true;
    if (!said_)
      world_.diagnostics.error(where, "the world takes more memory than " +
                                          share_.budget()->name() + "; " + what_ +
                                          " from here on are left out");
    said_ = true;
    return false;
  }
  void give(uint64_t bytes) { share_.give(bytes); }
  void clear() { share_.clear(); }
  const Budget& budget() const { return *share_.budget(); }

 private:
  World& world_;
  const char* what_;
  Share share_;
  bool said_ = false;
};

} // namespace xvrml::mapper
