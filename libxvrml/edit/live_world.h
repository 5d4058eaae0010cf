// live_world.h: the world that an editor shows its edits in: one that runs, or one that does not.
// Internal; the thread that owns the world.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "xvrml/browser.h"

namespace xvrml {

// Once another world has taken its place (isReplaced), edits of it do nothing.
class LiveWorld {
 public:
  virtual ~LiveWorld() = default;
  virtual World& world() = 0;
  // Sets a field as if the file had the value. Returns false for a value that the node refuses: it
  // keeps another one, as a TimeSensor that runs keeps its startTime.
  virtual bool set(Node& node, std::string_view field, Value value) = 0;
  // Makes nodes from a text without a header, as part of the world. name: for their places.
  virtual MFNode read(const std::string& text, const std::string& name) = 0;
  virtual void addRoot(const NodeRef& node, size_t index) = 0;
  virtual void removeRoot(Node& node, size_t index) = 0;
  // Returns whether another world has taken the place of this one.
  virtual bool isReplaced() const { return false; }
  virtual bool addRoute(Node& from, const std::string& out, Node& to, const std::string& in) = 0;
  virtual void removeRoute(Node& from, const std::string& out, Node& to, const std::string& in) = 0;
  // Returns the name that nodes of read() have in their places.
  virtual std::string placeName(const std::string& name) const = 0;
};

std::unique_ptr<LiveWorld> makeLiveWorld(Browser& browser);
std::unique_ptr<LiveWorld> makeLiveWorld(World& world);

} // namespace xvrml
