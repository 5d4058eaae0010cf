// gif.cpp: decodes the first picture of a GIF with giflib, record by record, so that nothing after
// it is read.
#include <gif_lib.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "image/decoders.h"

namespace xvrml {
namespace {

struct Source {
  std::span<const uint8_t> bytes;
  size_t position = 0;
};

int readBytes(GifFileType* gif, GifByteType* to, int count) {
  auto* source = static_cast<Source*>(gif->UserData);
  size_t n = std::min(size_t(std::max(count, 0)), source->bytes.size() - source->position);
  if (n) std::memcpy(to, source->bytes.data() + source->position, n);
  source->position += n;
  return int(n);
}

struct Closer {
  void operator()(GifFileType* gif) const { DGifCloseFile(gif, nullptr); }
};
using Gif = std::unique_ptr<GifFileType, Closer>;

[[noreturn]] void damaged(const char* what) {
  throw std::runtime_error(std::string("damaged GIF picture: ") + (what ? what : "unreadable"));
}

void check(GifFileType* gif, int result) {
  if (result == GIF_ERROR) damaged(GifErrorString(gif->Error));
}

// Reads an extension before the picture. The graphics control block has the transparent colour.
void readExtension(GifFileType* gif, int& transparent) {
  int code = 0;
  GifByteType* block = nullptr;
  check(gif, DGifGetExtension(gif, &code, &block));
  while (block) {
    GraphicsControlBlock control;
    if (code == GRAPHICS_EXT_FUNC_CODE &&
        DGifExtensionToGCB(block[0], block + 1, &control) == GIF_OK)
      transparent = control.TransparentColor;
    check(gif, DGifGetExtensionNext(gif, &block));
  }
}

// Returns the picture's colour indices, row by row from the top. Interlaced rows are put in order.
std::vector<uint8_t> readIndices(GifFileType* gif) {
  const size_t width = size_t(gif->Image.Width), height = size_t(gif->Image.Height);
  std::vector<uint8_t> inOrder;
  inOrder.reserve(width * height);
  std::vector<GifByteType> row(width);
  for (size_t y = 0; y < height; y++) {
    check(gif, DGifGetLine(gif, row.data(), int(width)));
    inOrder.insert(inOrder.end(), row.begin(), row.end());
  }
  if (!gif->Image.Interlace) return inOrder;
  std::vector<uint8_t> indices(inOrder.size());
  static constexpr size_t starts[] = {0, 4, 2, 1}, steps[] = {8, 8, 4, 2};
  size_t from = 0;
  for (int pass = 0; pass < 4; pass++)
    for (size_t y = starts[pass]; y < height; y += steps[pass], from++)
      std::copy_n(inOrder.begin() + ptrdiff_t(from * width), width,
                  indices.begin() + ptrdiff_t(y * width));
  return indices;
}

Image paint(GifFileType* gif, const std::vector<uint8_t>& indices, int transparent) {
  const ColorMapObject* map = gif->Image.ColorMap ? gif->Image.ColorMap : gif->SColorMap;
  if (!map || !map->Colors) damaged("no colour table");
  const int64_t left = gif->Image.Left, top = gif->Image.Top, width = gif->Image.Width,
                height = gif->Image.Height;
  Image image;
  image.width = gif->SWidth;
  image.height = gif->SHeight;
  bool covers =
      left <= 0 && top <= 0 && left + width >= image.width && top + height >= image.height;
  bool seen = transparent >= 0 &&
              std::find(indices.begin(), indices.end(), uint8_t(transparent)) != indices.end();
  image.components = covers && !seen ? 3 : 4;
  image.pixels.assign(size_t(image.width) * size_t(image.height) * size_t(image.components), 0);
  for (int64_t y = std::max<int64_t>(0, -top); y < height && y + top < image.height; y++) {
    uint8_t* row = image.pixels.data() + size_t(image.height - 1 - (y + top)) *
                                             size_t(image.width) * size_t(image.components);
    for (int64_t x = std::max<int64_t>(0, -left); x < width && x + left < image.width; x++) {
      int index = indices[size_t(y * width + x)];
      if (index == transparent) continue;
      GifColorType color = index < map->ColorCount ? map->Colors[index] : GifColorType{0, 0, 0};
      uint8_t* pixel = row + size_t(x + left) * size_t(image.components);
      pixel[0] = color.Red;
      pixel[1] = color.Green;
      pixel[2] = color.Blue;
      if (image.components == 4) pixel[3] = 255;
    }
  }
  return image;
}

} // namespace

Image decodeGif(std::span<const uint8_t> bytes, const ImageRoom& room) {
  Source source{bytes};
  int error = 0;
  Gif gif(DGifOpen(&source, readBytes, &error));
  if (!gif) damaged(GifErrorString(error));
  int transparent = NO_TRANSPARENT_COLOR;
  for (;;) {
    GifRecordType record = UNDEFINED_RECORD_TYPE;
    check(gif.get(), DGifGetRecordType(gif.get(), &record));
    if (record == EXTENSION_RECORD_TYPE)
      readExtension(gif.get(), transparent);
    else if (record == IMAGE_DESC_RECORD_TYPE)
      break;
    else
      damaged("no picture in it");
  }
  // The size of the screen is checked before any pixel is made, and the size of the picture before
  // any pixel is read.
  check(gif.get(), DGifGetImageHeader(gif.get()));
  if (gif->SWidth <= 0 || gif->SHeight <= 0) { // some programs leave the screen size out
    gif->SWidth = gif->Image.Width;
    gif->SHeight = gif->Image.Height;
  }
  const uint64_t width = uint64_t(std::max(gif->SWidth, 0)),
                 height = uint64_t(std::max(gif->SHeight, 0));
  const uint64_t pictureWidth = uint64_t(std::max(gif->Image.Width, 0)),
                 pictureHeight = uint64_t(std::max(gif->Image.Height, 0));
  checkImageSize(pictureWidth, pictureHeight, room.limits, "GIF");
  checkImageSize(width, height, 4, 2 * pictureWidth * pictureHeight, room, "GIF");
  // A code of 12 bits stands for fewer than 4096 pixels. A screen may be moderately larger than its
  // picture.
  checkFileSize(bytes.size(), pictureWidth * pictureHeight / 2731, "GIF");
  constexpr uint64_t freeScreen = 4 << 20;
  if (width * height > freeScreen) checkFileSize(bytes.size(), width * height / 2731, "GIF");
  std::vector<uint8_t> indices = readIndices(gif.get());
  return paint(gif.get(), indices, transparent);
}

} // namespace xvrml
