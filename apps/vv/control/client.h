// client.h: Holds what the browser's thread knows about a client: its commands that wait, the
// numbers of nodes that it has, and its subscriptions. [the browser's thread]
#pragma once

#include <deque>
#include <map>
#include <string>

#include "as_json/node_numbers.h"
#include "control/limits.h"
#include "control/mailbox.h"
#include "xvrml/browser.h"

namespace vv::control {

struct Client {
  ClientId id = 0;
  struct Waiting {
    Letter letter;
    uint64_t order = 0; // when it arrived, among those of all clients
  };
  std::deque<Waiting> waiting;
  // The command under way, whose answer comes later; the next ones wait for it.
  enum class Busy : uint8_t { no, rendering, loading } busy = Busy::no;
  Letter underWay;
  bool hasLeft = false;
  bool isServed = false; // a command has been begun: it hears of other worlds

  NodeNumbers numbers{limits.nodes};
  struct Subscription {
    xvrml::NodeRef node;
    uint64_t number = 0; // the number that Browser::listen gave
  };
  std::map<std::string, Subscription> subscriptions; // by node and field as the client names them
};

} // namespace vv::control
