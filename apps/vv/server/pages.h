// pages.h: The pages that are connected: who leads, who follows, who has a view of his own, and
// which picture each gets next. Pure logic, without connections. [one thread]
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "server/flow.h"

namespace vv::server {

// Views that a session can draw: number 0 is that of the one who leads, the others belong to pages
// with views of their own. The renderer remembers as many (libpicture/live.h).
inline constexpr uint32_t maxViews = 8;

struct Page {
  enum class Role : uint8_t {
    leader,   // moves the view that the world knows
    follower, // sees what the leader sees
    own       // has a view of its own
  };
  Role role = Role::follower;
  uint32_t view = 0;  // number of the view that the page shows
  PictureSize size;   // the size of its pictures
  bool sized = false; // the page has told its size; before, it gets no pictures
  PictureFlow flow;
  double answered = 0; // time of its last acknowledgement, or of the first picture
  // The file that is being made of a picture for this page. There is one at a time.
  enum class Saving : uint8_t { nothing, picture, file };
  Saving saving = Saving::nothing;
};

class Pages {
 public:
  // The first page leads.
  void join(uint64_t number, double now);
  // Removes a page. If it led, the page that has followed longest leads, or else that which has had
  // its own view longest.
  void leave(uint64_t number);
  // Gives a follower a view of its own. Returns its number; 0: the page is no follower, or there
  // are maxViews views already.
  uint32_t separate(uint64_t number);
  // Lets a page with a view of its own follow again. Returns whether that was so.
  bool follow(uint64_t number);

  Page* find(uint64_t number);
  // Returns the number of the page that leads; 0: there are no pages.
  uint64_t leader() const { return leader_; }
  // Returns the number of the page that the view belongs to; 0: none.
  uint64_t ownerOf(uint32_t view) const;
  std::map<uint64_t, Page>& all() { return pages_; }
  size_t count() const { return pages_.size(); }
  // Returns the number of views: that of the world, and those of pages with one of their own.
  size_t views() const;

  // Tells whether anybody looks: a page that has had no picture yet, or has acknowledged one
  // lately. Pages that are hidden do not acknowledge.
  bool isWatched(double now) const;

 private:
  std::map<uint64_t, Page> pages_; // by number: the page that has been here longest comes first
  uint64_t leader_ = 0;
};

} // namespace vv::server
