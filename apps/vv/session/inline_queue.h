// inline_queue.h: Loads a running world's Inlines a few at a time, after the first picture. Owned
// by a session. [the browser's thread]
#pragma once

#include <cstdint>
#include <deque>

#include "xvrml/browser.h"

namespace vv {

class InlineQueue {
 public:
  // The transitions are in collect() and loadSome(). No state follows loaded or abandoned.
  enum class State : uint8_t {
    loading,  // Inlines are in the queue
    loaded,   // the queue is empty
    abandoned // a Script has replaced the world
  };

  // The browser must outlive the queue.
  explicit InlineQueue(xvrml::Browser& browser) : browser_(browser) {}

  // Fills the queue with the world's Inlines that are not loaded.
  void collect();
  // Loads Inlines for about 10 ms. Returns true once: when the last one has been loaded.
  bool loadSome();
  bool isLoading() const { return state_ == State::loading; }

 private:
  void add(const xvrml::Node& node);

  xvrml::Browser& browser_;
  State state_ = State::loaded;
  std::deque<xvrml::NodeRef> waiting_;
  uint64_t generation_ = 0; // generation of the browser's world that contains the Inlines
};

} // namespace vv
