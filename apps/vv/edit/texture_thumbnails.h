// texture_thumbnails.h: Small pictures of the texture nodes that a sheet shows. The files are read
// as the world reads its pictures, and decoded on a thread of their own, one after the other.
// Owned by an EditModel. [the browser's thread, while the world can be used]
#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <string>
#include <vector>

#include "edit/properties.h"
#include "xvrml/appearance.h"

namespace vv {

struct Thumbnail {
  static constexpr int side = 64; // pixels; neither width nor height is more
  uint64_t number = 0;            // those with different pixels have different numbers
  int width = 0, height = 0;      // 0: there is none
  std::vector<uint8_t> rgba;      // first row at the top
  std::string error;              // why there is none

  // Returns how much larger it is shown, so that a texture of a few pixels can be seen.
  int magnification() const;
};
// Returns the means of parts of a picture, without a number; without pixels if it has none. A part
// is taken as at most 5 x 5 of its pixels, so that large pictures take no longer. [any thread]
Thumbnail thumbnailOf(const xvrml::Image& image);

class TextureThumbnails {
 public:
  static constexpr size_t mostShown = 12; // further textures of a sheet have none
  // Files with more pixels are not decoded for a thumbnail.
  static constexpr uint64_t mostPixels = 32 << 20;

  // Follows a sheet. isRead: its values were read again. Returns whether others are shown now.
  bool update(const xvrml::World& world, const PropertySheet& sheet, bool isRead);
  // Returns the thumbnail of a node of the sheet, or of the sheet's own; null: there is none, or
  // not yet, and nothing is wrong.
  const Thumbnail* of(const xvrml::Node& node) const;
  // Grows when others are shown.
  uint64_t count() const { return count_; }
  // Returns the nodes that have one.
  std::vector<xvrml::NodeRef> nodes() const;

 private:
  struct Entry {
    xvrml::NodeRef node;
    size_t urls = 0;     // a number of its URLs, which differs where they do
    bool isDue = false;  // its file must be read
    size_t url = 0;      // the URL to begin with: those before it cannot be decoded
    std::string error{}; // what is wrong with the first of these
    Thumbnail thumbnail{};
    bool isShown() const { return thumbnail.width > 0 || !thumbnail.error.empty(); }
  };
  struct Decoded {
    Thumbnail thumbnail;
    bool isDamaged = false; // renderers show the picture of another URL
  };
  // A file that is being decoded.
  struct Decoding {
    xvrml::NodeRef node;
    size_t urls = 0;
    size_t url = 0; // which of them it is
    std::future<Decoded> result;
  };

  bool look(const PropertySheet& sheet);
  static Decoded decoded(xvrml::TexturePicture picture);
  bool begin(const xvrml::World& world);
  bool take();
  void show(Entry& entry, Thumbnail thumbnail);

  std::vector<Entry> entries_; // those of the present sheet
  uint64_t count_ = 0;         // thumbnails, and sets of them, so far
  Decoding decoding_;
};

} // namespace vv
