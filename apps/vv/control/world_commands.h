// world_commands.h: Does the commands that need only the running world. Those that edit its file
// are in world_edits.cpp. [the browser's thread, while the session rests]
#pragma once

#include <string>

#include "control/client.h"
#include "control/command.h"
#include "control/mailbox.h"
#include "session/session.h"

namespace vv::control {

class WorldCommands {
 public:
  WorldCommands(Session& session, Client& client, Mailbox& mailbox)
      : session_(session), browser_(session.browser()), client_(client), mailbox_(mailbox) {}

  // Does a command and returns its result as JSON. Throws CommandError, and what the library
  // throws. Hello, Load, Render, Probe, Measure and Quit are not commands of the world.
  std::string perform(const Command& command);
  // Returns what is seen at a place of the picture, or "null".
  std::string pick(const Pick& pick);

  // Ends the subscriptions of a client.
  static void unsubscribeAll(xvrml::Browser& browser, Client& client);

 private:
  std::string get(const Get& get);
  std::string set(const Set& set);
  std::string subscribe(const Subscribe& subscribe);
  std::string create(const Create& create);
  std::string changeRoots(const ChangeRoots& change);
  std::string release(const Release& release);
  std::string changeRoute(const ChangeRoute& change);
  std::string describe(const Describe& describe);
  std::string listNames() const;
  std::string listViewpoints();
  std::string bind(const Bind& bind);
  std::string replace(const Replace& replace);
  std::string time(const Time& time);
  std::string press(const PressKey& press);

  std::string edit(const edits::Step& step);
  std::string undo(const Undo& undo);
  std::string save(const Save& save);
  std::string listEdits(const ListEdits& list);
  std::string throwLeftAway();
  std::string listRoots();
  std::string listParents(const ListParents& list);
  std::string listParameters(const ListParameters& list);
  std::string select(const Select& select);
  std::string listSelection();

  xvrml::NodeRef nodeOf(const NodeName& name) const;
  std::string valueText(const xvrml::Value& value);
  // Returns number, type and DEF name of a node; "null" for null.
  std::string factsOf(const xvrml::NodeRef& node);
  std::string factsOf(const xvrml::MFNode& nodes);

  Session& session_;
  xvrml::Browser& browser_;
  Client& client_;
  Mailbox& mailbox_;
};

} // namespace vv::control
