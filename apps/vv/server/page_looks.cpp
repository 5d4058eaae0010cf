#include "server/page_looks.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "libpicture/files/formats.h"
#include "server/edit_texts.h"
#include "server/limits.h"

namespace vv::server {

using xvrml::EditError;

void PageLooks::setChoosing(uint64_t page, bool isChoosing) {
  if (!isChoosing) {
    choosing_.erase(page);
    return;
  }
  choosing_.insert(page);
  library_.refresh();
  isStale_ = true;
}

void PageLooks::update(Session& session, const std::vector<Look>& installed) {
  if (text_.empty()) library_.refresh();
  PictureLoop& pictures = session.pictures();
  const bool isStill = pictures.isRefining() && !session.viewers().own().isOutdated();
  const bool mayRender = isStill && (!choosing_.empty() || pictures.isFinished(session.pilot()));
  isStale_ |= library_.advance(installed, session.editor().shaderPath(), mayRender);
  if (std::exchange(isStale_, false)) write(installed);
}

const Look& PageLooks::find(uint64_t number) const {
  if (number >= known_.size()) throw EditError("there is no such look");
  return known_[number];
}

// Numbers are never used for other looks, because a page may name one that it was sent earlier.
uint64_t PageLooks::numberOf(const Look& look) {
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const Look& one) {
    return one.file == look.file && one.library == look.library && one.name == look.name;
  });
  if (found == known_.end()) return known_.push_back(look), known_.size() - 1;
  return uint64_t(found - known_.begin());
}

// Returns the path of the picture of a look's ball; "": there is none.
std::string PageLooks::imageOf(uint64_t number, const Look& look) {
  Image& image = images_[number];
  const LookBall* const ball = library_.ballOf(look);
  if (!ball || ball->number == image.ball) return image.path;
  if (!image.path.empty()) host_.dropImage(image.path);
  image = {ball->number, {}};
  try {
    image.path = host_.keepImage(picture::pngOf(ball->rgb, LookBall::side, LookBall::side, 3));
  } catch (const std::exception&) {} // there is no memory: the look goes without
  return image.path;
}

void PageLooks::write(const std::vector<Look>& installed) {
  std::vector<edit::ShownLook> shown;
  for (const std::vector<Look>* looks : {&library_.own(), &installed})
    for (const Look& one : *looks) {
      if (shown.size() == size_t(maxLooksShown)) break;
      const uint64_t number = numberOf(one);
      shown.push_back({number, &one, imageOf(number, one)});
    }
  text_ = edit::looksText(shown);
}

} // namespace vv::server
