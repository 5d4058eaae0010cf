// media.h: what AudioClip and MovieTexture have in common: a file that is loaded, its duration, and
// when it plays (clauses 4.6.9, 6.4, 6.28). [the browser's thread]
#pragma once

#include "base/budget.h"
#include "behaviour/builtin.h"
#include "behaviour/time_dependent.h"

namespace xvrml {

class Media : public NodeState {
 public:
  // Loads what url names and returns its length in seconds; -1, with a message, if it cannot be
  // had.
  virtual double load(Events& events, Node& node) = 0;
  // duration: as load() returned it; the cycle follows from it and the node's rate.
  virtual TimeFields fields(const Node& node) const = 0;
  // Each step while it plays, the last included.
  virtual void play(Events& events, Node& node, const TimeStep& step) = 0;

  TimeDependent time;
  double duration = -1;
};

// begin: makes the state and calls beginMedia. pitch and speed are rates, which an active node does
// not change.
void addMedia(const AddBehaviour& add, const NodeType& type,
              std::unique_ptr<NodeState> (*begin)(Events&, Node&));
// For begin functions: loads, and says the duration.
std::unique_ptr<NodeState> beginMedia(Events& events, Node& node, std::unique_ptr<Media> state);

// Calls read(path) with the file that each URL of a list means, until it returns true; it throws
// std::exception to say why not. Otherwise one message with the first reason. node: whose URLs they
// are.
bool readFirst(Events& events, const Node& node, const MFString& urls,
               const std::function<bool(const std::string& path)>& read);
// The limits of the world that events runs; defaults without a browser.
const LoadOptions& loadOptions(const Events& events);
// An empty share of the budget of the world that events runs; without a browser of none.
Share mediaShare(const Events& events);
// Says that so many bytes are more than the budget has left.
std::string tooMuch(uint64_t bytes, const Budget& budget);

} // namespace xvrml
