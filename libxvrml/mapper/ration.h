// ration.h: what one part of the mapper takes from the budget of its world (base/budget.h), with
// one message when nothing is left. [the mapper's thread]
#pragma once

#include "base/budget.h"
#include "mapper/graph/cost.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

class Quota {
 public:
  // what: the name of the omitted things in the message, such as "lights".
  Quota(World& world, const char* what) : world_(world), what_(what), share_(budgetOf(world)) {}

  // Takes bytes for something at `where`. Returns false if too few are left; the first time it also
  // reports an error.
  bool take(uint64_t bytes, const SourcePosition& where) {
    if (share_.take(bytes)) return true;
    if (!reported_)
      world_.diagnostics.error(where, "the world takes more memory than " +
                                          share_.budget()->name() + "; " + what_ +
                                          " from here on are left out");
    reported_ = true;
    return false;
  }
  void give(uint64_t bytes) { share_.give(bytes); }
  void clear() { share_.clear(); }
  const Budget& budget() const { return *share_.budget(); }

 private:
  World& world_;
  const char* what_;
  Share share_;
  bool reported_ = false;
};

} // namespace xvrml::mapper
