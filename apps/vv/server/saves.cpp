#include "server/saves.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "libpicture/files/formats.h"
#include "server/limits.h"
#include "server/texts.h"
#include "session/saving.h"

namespace vv::server {

double Saves::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Saves::want(uint64_t number, Message::Format format) {
  takeMadeFiles();
  Page* const page = pages_.find(number);
  if (!page || page->saving != Page::Saving::nothing) return;
  page->saving = Page::Saving::picture;
  queue_.want({number, format});
}

void Saves::giveUp(uint64_t number) {
  if (queue_.drop(number))
    end(number);
  else
    world_.session().captures().giveUp(number);
}

void Saves::advance() {
  const std::optional<SaveQueue::Wish> wish = queue_.begin(seconds());
  if (!wish) return;
  if (const Page* const page = pages_.find(wish->page))
    capture(*wish, *page);
  else
    queue_.end(seconds(), false);
}

void Saves::capture(const SaveQueue::Wish& wish, const Page& page) {
  world_.session().capture(page.view, wish.page, [this, wish](const picture::Picture* picture) {
    queue_.end(seconds(), pages_.count() > 1);
    reports_.hurry();
    if (!picture) return end(wish.page);
    // Pictures that wait here need much memory, and more than these would not be kept.
    takeMadeFiles();
    if (inMaking_ >= maxDownloads) return end(wish.page, ": too many others are being saved");
    makeFile(wish, *picture);
  });
}

void Saves::makeFile(const SaveQueue::Wish& wish, const picture::Picture& picture) {
  ++inMaking_;
  if (Page* const page = pages_.find(wish.page)) page->saving = Page::Saving::file;
  const std::string suffix = wish.format == Message::Format::exr ? "exr" : "png";
  const std::string name = downloadName(world_.session().browser().world().path,
                                        fmt::format("-{}.{}", ++begun_, suffix));
  auto wanted =
      std::make_shared<picture::Picture>(picture::withChannels(picture, options_.render.channels));
  encoder_.post(
      [this, number = wish.page, name, suffix, wanted] { encode(number, name, suffix, *wanted); });
}

// [the encoder's thread]
void Saves::encode(uint64_t page, const std::string& name, const std::string& suffix,
                   const picture::Picture& picture) {
  std::string path;
  try {
    path =
        host_.offerDownload(name, "image/" + suffix, picture::formatNamed(suffix)->encode(picture));
  } catch (const std::exception&) { host_.close(page); }
  {
    const std::lock_guard lock(mutex_);
    made_.push_back(page); // before the page is told, because it may save again at once
  }
  if (!path.empty()) host_.sendText(page, "", savedText(path, name));
}

// Lets the pages whose files have been made save again.
void Saves::takeMadeFiles() {
  std::vector<uint64_t> made;
  {
    const std::lock_guard lock(mutex_);
    made.swap(made_);
  }
  inMaking_ -= int(made.size());
  for (const uint64_t number : made)
    if (Page* const page = pages_.find(number)) page->saving = Page::Saving::nothing;
}

void Saves::loseAll() {
  queue_.clear();
  for (auto& [number, page] : pages_.all())
    if (page.saving == Page::Saving::picture) end(number, ": the world has been replaced");
}

// Tells a page that it gets no file.
void Saves::end(uint64_t number, std::string_view why) {
  Page* const page = pages_.find(number);
  if (!page || page->saving == Page::Saving::nothing) return;
  page->saving = Page::Saving::nothing;
  notify_(page->view, fmt::format("the picture is not saved{}", why));
}

} // namespace vv::server
