// page_looks.h: The looks that pages can choose from: the user's own files and what is installed,
// with a picture of a ball each, which pages fetch. All pages share them. Owned by the editing of
// the server. [main thread, while the world can be used]
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "edit/look_library.h"
#include "server/host.h"
#include "session/session.h"

namespace vv::server {

class PageLooks {
 public:
  // The host must outlive this object.
  explicit PageLooks(Host& host) : host_(host) {}

  // The user of a page chooses a look, or does not any more. The user's files are read again.
  void setChoosing(uint64_t page, bool isChoosing);
  // Draws the next ball, while the session's picture needs nobody. installed: the looks that can be
  // chosen everywhere.
  void update(Session& session, const std::vector<Look>& installed);
  // Returns the message with all looks; "": none are known yet.
  const std::string& text() const { return text_; }
  // Returns the look that pages know by a number. Throws xvrml::EditError.
  const Look& find(uint64_t number) const;

 private:
  // The picture of a look's ball, and its number (LookBall).
  struct Image {
    uint64_t ball = 0;
    std::string path;
  };

  uint64_t numberOf(const Look& look);
  std::string imageOf(uint64_t number, const Look& look);
  void write(const std::vector<Look>& installed);

  Host& host_;
  LookLibrary library_;
  std::set<uint64_t> choosing_;      // pages
  std::vector<Look> known_;          // a look's number is its place
  std::map<uint64_t, Image> images_; // by the numbers of looks
  std::string text_;
  bool isStale_ = true;
};

} // namespace vv::server
