#include "session/inline_queue.h"

#include <chrono>
#include <utility>

#include "report/describe.h"

namespace vv {

void InlineQueue::add(const xvrml::Node& node) {
  if (node.type().name == "Inline" && !xvrml::inlineScope(node))
    waiting_.emplace_back(const_cast<xvrml::Node*>(&node));
}

void InlineQueue::collect() {
  forEachNode(browser_.world(), [this](const xvrml::Node& node) { add(node); });
  generation_ = browser_.generation();
  state_ = waiting_.empty() ? State::loaded : State::loading;
}

bool InlineQueue::loadSome() {
  if (state_ != State::loading) return false;
  if (browser_.generation() != generation_) {
    waiting_.clear();
    state_ = State::abandoned;
    return false;
  }
  const auto start = std::chrono::steady_clock::now();
  while (!waiting_.empty() &&
         std::chrono::steady_clock::now() - start < std::chrono::milliseconds(10)) {
    const xvrml::NodeRef node = std::move(waiting_.front());
    waiting_.pop_front();
    if (xvrml::inlineScope(*node) || !browser_.loadInline(*node)) continue;
    forEachNodeBelow(*node, [this](const xvrml::Node& below) { add(below); });
  }
  if (waiting_.empty()) state_ = State::loaded;
  return state_ == State::loaded;
}

} // namespace vv
