// media.h: the common part of AudioClip and MovieTexture: a loaded file, its duration and its
// playing time (clauses 4.6.9, 6.4, 6.28). [the browser's thread]
#pragma once

#include "base/budget.h"
#include "behaviour/builtin.h"
#include "behaviour/time_dependent.h"

namespace xvrml {

class Media : public NodeState {
 public:
  // Loads the node's url and returns its length in seconds. Returns -1, after a message, if loading
  // fails.
  virtual double load(Events& events, Node& node) = 0;
  // Returns the timing fields. The cycle follows from `duration` (the result of load()) and the
  // node's rate.
  virtual TimeFields fields(const Node& node) const = 0;
  // Called for each step while the node plays, including the last one.
  virtual void play(Events& events, Node& node, const TimeStep& step) = 0;

  TimeDependent time;
  double duration = -1;
};

// Adds the behaviour of a media node. begin: makes the state and calls beginMedia. An active node
// ignores changes of its rates pitch and speed.
void addMedia(const AddBehaviour& add, const NodeType& type,
              std::unique_ptr<NodeState> (*begin)(Events&, Node&));
// Loads the file and sends duration_changed. Called by begin functions.
std::unique_ptr<NodeState> beginMedia(Events& events, Node& node, std::unique_ptr<Media> state);

// Calls read(path) with the file of each URL in a list until it returns true. read throws
// std::exception to give a reason for failure. If all fail, one message is written with the first
// reason. node: the node that has the URLs.
bool readFirst(Events& events, const Node& node, const MFString& urls,
               const std::function<bool(const std::string& path)>& read);
// Returns the load options of the running world; defaults if there is no browser.
const LoadOptions& loadOptions(const Events& events);
// Returns an empty share of the running world's budget; without a browser, of no budget.
Share mediaShare(const Events& events);
// Returns the message that so many bytes exceed what the budget has left.
std::string overBudgetMessage(uint64_t bytes, const Budget& budget);

} // namespace xvrml
