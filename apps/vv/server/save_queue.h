// save_queue.h: Decides when the next picture for a file is rendered. The pictures of all pages
// wait for it; so while others look, no more than half of the time goes to files. Pure logic. [one
// thread]
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "server/message.h"

namespace vv::server {

class SaveQueue {
 public:
  struct Wish {
    uint64_t page;
    Message::Format format;
  };
  // A page wants its picture as a file.
  void want(const Wish& wish) { waiting_.push_back(wish); }
  // Returns the wish whose rendering begins now, if it is time for one. now: seconds of any clock.
  std::optional<Wish> begin(double now) {
    if (rendering_ || waiting_.empty() || now < next_) return {};
    const Wish wish = waiting_.front();
    waiting_.pop_front();
    rendering_ = true;
    begun_ = now;
    return wish;
  }
  // The rendering has ended. The next one waits for as long as this one took if `others` look.
  void end(double now, bool others) {
    rendering_ = false;
    next_ = others ? now + (now - begun_) : now;
  }
  // Drops the wish of a page. Returns false if none waits.
  bool drop(uint64_t page) {
    return std::erase_if(waiting_, [page](const Wish& one) { return one.page == page; }) > 0;
  }
  // Drops all wishes, and the rendering.
  void clear() { *this = {}; }

 private:
  std::deque<Wish> waiting_;
  bool rendering_ = false;
  double begun_ = 0, next_ = 0;
};

} // namespace vv::server
