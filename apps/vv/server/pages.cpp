#include "server/pages.h"

#include <algorithm>

namespace vv::server {

namespace {

// Seconds after which a page that does not acknowledge its picture counts as not looking.
constexpr double patience = 2;

} // namespace

void Pages::join(uint64_t number, double now) {
  Page& page = pages_[number];
  page.answered = now;
  if (leader_ == 0) {
    leader_ = number;
    page.role = Page::Role::leader;
  }
}

void Pages::leave(uint64_t number) {
  pages_.erase(number);
  if (number != leader_) return;
  leader_ = 0;
  auto next = std::find_if(pages_.begin(), pages_.end(),
                           [](const auto& one) { return one.second.role == Page::Role::follower; });
  if (next == pages_.end()) next = pages_.begin();
  if (next == pages_.end()) return;
  leader_ = next->first;
  next->second.role = Page::Role::leader;
  next->second.view = 0;
}

uint32_t Pages::separate(uint64_t number) {
  Page* const page = find(number);
  if (!page || page->role != Page::Role::follower) return 0;
  for (uint32_t view = 1; view < maxViews; ++view)
    if (ownerOf(view) == 0) {
      page->role = Page::Role::own;
      return page->view = view;
    }
  return 0;
}

bool Pages::follow(uint64_t number) {
  Page* const page = find(number);
  if (!page || page->role != Page::Role::own) return false;
  page->role = Page::Role::follower;
  page->view = 0;
  return true;
}

Page* Pages::find(uint64_t number) {
  const auto found = pages_.find(number);
  return found == pages_.end() ? nullptr : &found->second;
}

size_t Pages::views() const {
  return 1 + size_t(std::count_if(pages_.begin(), pages_.end(), [](const auto& one) {
           return one.second.role == Page::Role::own;
         }));
}

uint64_t Pages::ownerOf(uint32_t view) const {
  if (view == 0) return leader_;
  for (const auto& [number, page] : pages_)
    if (page.view == view) return number;
  return 0;
}

bool Pages::isWatched(double now) const {
  return std::any_of(pages_.begin(), pages_.end(), [&](const auto& one) {
    const Page& page = one.second;
    return page.sized && (!page.flow.isWaiting() || now - page.answered < patience);
  });
}

} // namespace vv::server
