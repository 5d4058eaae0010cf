#include "edit/texture_thumbnails.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <system_error>
#include <utility>

#include "libpicture/export/picture_source.h"
#include "xvrml/nodes.h"

namespace vv {

using namespace xvrml;

namespace {

constexpr int samplesAlong = 5; // the most pixels of a part, in each direction

// Where the pixels of a part lie along one axis.
struct Span {
  int first, step, end;
};
Span spanOf(int part, int parts, int pixels) {
  const auto at = [&](int i) { return int(int64_t(i) * pixels / parts); };
  const int first = at(part), end = std::max(at(part + 1), first + 1);
  return {first, std::max(1, (end - first) / samplesAlong + ((end - first) % samplesAlong != 0)),
          end};
}

bool isWhole(const Image& image) {
  return image.width > 0 && image.height > 0 && image.components >= 1 && image.components <= 4 &&
         image.pixels.size() >=
             size_t(image.width) * size_t(image.height) * size_t(image.components);
}

// Adds a pixel as red, green, blue and alpha. y: the row from the top; those of images begin at the
// bottom.
void addPixel(const Image& image, int x, int y, std::array<uint32_t, 4>& sum) {
  const auto components = size_t(image.components);
  const uint8_t* const from =
      image.pixels.data() +
      (size_t(image.height - 1 - y) * size_t(image.width) + size_t(x)) * components;
  const bool isGrey = components < 3;
  for (size_t i = 0; i < 3; ++i) sum[i] += from[isGrey ? 0 : i];
  sum[3] += components % 2 == 0 ? from[components - 1] : 255;
}

Node* textureIn(const NodeRef& node) {
  Node* const rendered = node ? renderedNode(node.get()) : nullptr;
  const bool hasPicture =
      nodeCast<nodes::ImageTexture>(rendered) || nodeCast<nodes::PixelTexture>(rendered);
  return hasPicture ? rendered : nullptr;
}

// Returns the textures of a sheet: its own node, and the nodes of its fields.
MFNode texturesOf(const PropertySheet& sheet) {
  MFNode textures;
  const auto add = [&](const NodeRef& node) {
    if (textures.size() < TextureThumbnails::mostShown && textureIn(node) &&
        std::find(textures.begin(), textures.end(), node) == textures.end())
      textures.push_back(node);
  };
  add(sheet.node);
  for (const PropertyRow& row : sheet.rows) {
    if (const auto* const one = std::get_if<SFNode>(&row.value)) add(*one);
    if (const auto* const list = std::get_if<MFNode>(&row.value))
      for (const NodeRef& one : *list) add(one);
  }
  return textures;
}

size_t numberOf(const MFString& urls) {
  size_t number = urls.size();
  for (const std::string& url : urls) number = number * 31 + std::hash<std::string>()(url);
  return number;
}

Thumbnail failed(std::string error) {
  Thumbnail thumbnail;
  thumbnail.error = std::move(error);
  return thumbnail;
}

} // namespace

int Thumbnail::magnification() const { return std::max(1, side / std::max({1, width, height})); }

Thumbnail thumbnailOf(const Image& image) {
  Thumbnail thumbnail;
  if (!isWhole(image)) return thumbnail;
  const double scale = std::min(1.0, double(Thumbnail::side) / std::max(image.width, image.height));
  const auto scaled = [scale](int size) { return std::max(1, int(std::lround(size * scale))); };
  thumbnail.width = scaled(image.width);
  thumbnail.height = scaled(image.height);
  thumbnail.rgba.reserve(size_t(thumbnail.width) * size_t(thumbnail.height) * 4);
  for (int y = 0; y < thumbnail.height; ++y)
    for (int x = 0; x < thumbnail.width; ++x) {
      const Span rows = spanOf(y, thumbnail.height, image.height),
                 columns = spanOf(x, thumbnail.width, image.width);
      std::array<uint32_t, 4> sum{};
      uint32_t count = 0;
      for (int row = rows.first; row < rows.end; row += rows.step)
        for (int column = columns.first; column < columns.end; column += columns.step, ++count)
          addPixel(image, column, row, sum);
      for (const uint32_t part : sum) thumbnail.rgba.push_back(uint8_t((part + count / 2) / count));
    }
  return thumbnail;
}

bool TextureThumbnails::update(const World& world, const PropertySheet& sheet, bool isRead) {
  bool isNew = take();
  if (isRead) isNew |= look(sheet);
  if (!decoding_.result.valid()) isNew |= begin(world);
  return isNew;
}

const Thumbnail* TextureThumbnails::of(const Node& node) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& one) { return one.node.get() == &node; });
  return found == entries_.end() || !found->isShown() ? nullptr : &found->thumbnail;
}

std::vector<NodeRef> TextureThumbnails::nodes() const {
  std::vector<NodeRef> nodes;
  for (const Entry& entry : entries_)
    if (entry.isShown()) nodes.push_back(entry.node);
  return nodes;
}

TextureThumbnails::Decoded TextureThumbnails::decoded(TexturePicture picture) {
  Limits limits;
  limits.imagePixels = mostPixels;
  decodeTexture(picture, limits);
  if (picture.error.empty()) return {thumbnailOf(picture::shownImage(picture))};
  return {failed(picture.error), !picture.tooManyPixels};
}

void TextureThumbnails::show(Entry& entry, Thumbnail thumbnail) {
  entry.thumbnail = std::move(thumbnail);
  entry.thumbnail.number = ++count_;
}

// Finds the textures of the sheet and what has changed about them. The pixels of a PixelTexture are
// at hand.
bool TextureThumbnails::look(const PropertySheet& sheet) {
  std::vector<Entry> before = std::exchange(entries_, {});
  bool isNew = false;
  for (const NodeRef& node : texturesOf(sheet)) {
    const auto known = std::find_if(before.begin(), before.end(),
                                    [&](const Entry& one) { return one.node == node; });
    const bool isKnown = known != before.end();
    isNew |= !isKnown;
    Entry entry = isKnown ? std::move(*known) : Entry{node};
    const Node* const texture = textureIn(node);
    if (const auto* const file = nodeCast<nodes::ImageTexture>(texture)) {
      const size_t urls = numberOf(file->url);
      if (!isKnown || urls != entry.urls) {
        entry.isDue = true;
        entry.urls = urls;
        entry.url = 0;
        entry.error.clear();
      }
    } else if (const auto* const pixels = nodeCast<nodes::PixelTexture>(texture)) {
      Thumbnail now = thumbnailOf(pixels->image);
      if (now.width != entry.thumbnail.width || now.rgba != entry.thumbnail.rgba) {
        show(entry, std::move(now));
        isNew = true;
      }
    }
    entries_.push_back(std::move(entry));
  }
  isNew |= entries_.size() != before.size();
  if (isNew) ++count_;
  return isNew;
}

// Reads the next file, and lets it be decoded. Returns whether it has failed at once.
bool TextureThumbnails::begin(const World& world) {
  const auto due =
      std::find_if(entries_.begin(), entries_.end(), [](const Entry& one) { return one.isDue; });
  if (due == entries_.end()) return false;
  due->isDue = false;
  const Node* const texture = textureIn(due->node);
  if (!texture) return false;
  try {
    TexturePicture picture = texturePicture(*texture, world, Decode::no, due->url);
    if (!picture.file.empty()) {
      decoding_ = {due->node, due->urls, picture.url,
                   std::async(std::launch::async, [picture = std::move(picture)]() mutable {
                     return decoded(std::move(picture));
                   })};
      return false;
    }
    show(*due, failed(due->error.empty() ? picture.error : due->error));
  } catch (const std::exception& failure) { // there is no memory, or no thread
    show(*due, failed(failure.what()));
  }
  return true;
}

// Takes the thumbnail that has been decoded. Returns whether it is shown. A file that is damaged
// makes the next URL due, as it does for renderers.
bool TextureThumbnails::take() {
  using namespace std::chrono_literals;
  if (!decoding_.result.valid() || decoding_.result.wait_for(0s) == std::future_status::timeout)
    return false;
  Decoded decoded;
  try {
    decoded = decoding_.result.get();
  } catch (const std::exception& failure) { decoded.thumbnail = failed(failure.what()); }
  const auto entry = std::find_if(entries_.begin(), entries_.end(), [this](const Entry& one) {
    return one.node == decoding_.node && one.urls == decoding_.urls;
  });
  if (entry == entries_.end()) return false;
  if (decoded.isDamaged) {
    if (entry->error.empty()) entry->error = std::move(decoded.thumbnail.error);
    entry->url = decoding_.url + 1;
    entry->isDue = true;
    return false;
  }
  show(*entry, std::move(decoded.thumbnail));
  return true;
}

} // namespace vv
