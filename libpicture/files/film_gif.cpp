// film_gif.cpp: Encodes animated GIF with giflib. Each picture has a palette of its own, made by
// median cut (Heckbert, "Color image quantization for frame buffer display", 1982). Colours are
// dithered by error diffusion (Floyd and Steinberg, 1976).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gif_lib.h>

#include "libpicture/files/film.h"

namespace picture {

namespace {

constexpr int maxColours = 256;
constexpr int bits = 5; // bits per channel in the histogram
constexpr int levels = 1 << bits;

// A cell of the histogram: the number of its pixels and the sum of their colours.
struct Cell {
  uint32_t count = 0;
  std::array<uint64_t, 3> sum{};
  std::array<uint8_t, 3> at{}; // position, 0 to levels - 1 on each axis
};

// The cells first to last - 1, which share one colour of the palette.
struct Box {
  size_t first, last;
  int axis = 0;      // longest axis
  uint64_t size = 0; // number of pixels times length; the largest box is split next
};

void measure(Box& box, const std::vector<Cell>& cells) {
  uint64_t pixels = 0;
  std::array<int, 3> low{levels, levels, levels}, high{-1, -1, -1};
  for (size_t i = box.first; i < box.last; ++i) {
    pixels += cells[i].count;
    for (size_t k = 0; k < 3; ++k) {
      low[k] = std::min<int>(low[k], cells[i].at[k]);
      high[k] = std::max<int>(high[k], cells[i].at[k]);
    }
  }
  int length = 0;
  for (int k : {1, 0, 2}) { // green first: the eye resolves its steps best
    if (high[size_t(k)] - low[size_t(k)] <= length) continue;
    length = high[size_t(k)] - low[size_t(k)];
    box.axis = k;
  }
  box.size = pixels * uint64_t(length);
}

std::vector<Cell> histogram(std::span<const uint8_t> rgb) {
  std::vector<Cell> all(size_t(levels) * levels * levels), used;
  for (size_t i = 0; i < rgb.size(); i += 3) {
    std::array<uint8_t, 3> at;
    for (size_t k = 0; k < 3; ++k) at[k] = uint8_t(rgb[i + k] >> (8 - bits));
    Cell& cell = all[(size_t(at[0]) * levels + at[1]) * levels + at[2]];
    cell.at = at;
    ++cell.count;
    for (size_t k = 0; k < 3; ++k) cell.sum[k] += rgb[i + k];
  }
  std::copy_if(all.begin(), all.end(), std::back_inserter(used),
               [](const Cell& cell) { return cell.count > 0; });
  return used;
}

std::vector<GifColorType> medianCut(std::span<const uint8_t> rgb) {
  std::vector<Cell> cells = histogram(rgb);
  std::vector<Box> boxes{{0, cells.size()}};
  measure(boxes[0], cells);
  while (boxes.size() < maxColours) {
    const auto largest = std::max_element(
        boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.size < b.size; });
    if (largest->size == 0) break; // every box is a single cell
    Box& box = *largest;
    const auto axis = size_t(box.axis);
    std::stable_sort(cells.begin() + long(box.first), cells.begin() + long(box.last),
                     [axis](const Cell& a, const Cell& b) { return a.at[axis] < b.at[axis]; });
    uint64_t half = 0, before = 0;
    for (size_t i = box.first; i < box.last; ++i) half += cells[i].count;
    half /= 2;
    size_t cut = box.first + 1; // both parts hold at least one cell
    for (before = cells[box.first].count; cut + 1 < box.last && before < half; ++cut)
      before += cells[cut].count;
    Box second{cut, box.last};
    box.last = cut;
    measure(box, cells);
    measure(second, cells);
    boxes.push_back(second);
  }
  std::vector<GifColorType> palette;
  for (const Box& box : boxes) {
    uint64_t count = 0;
    std::array<uint64_t, 3> sum{};
    for (size_t i = box.first; i < box.last; ++i) {
      count += cells[i].count;
      for (size_t k = 0; k < 3; ++k) sum[k] += cells[i].sum[k];
    }
    const auto mean = [&](size_t k) {
      return GifByteType((sum[k] + count / 2) / std::max<uint64_t>(count, 1));
    };
    palette.push_back({mean(0), mean(1), mean(2)});
  }
  return palette;
}

// Finds the nearest colour of a palette. Results are cached for cells of the histogram's size.
class Nearest {
 public:
  explicit Nearest(const std::vector<GifColorType>& palette)
      : palette_(palette), known_(size_t(levels) * levels * levels, -1) {}
  int operator()(const std::array<int, 3>& colour) {
    const size_t cell =
        (size_t(colour[0] >> (8 - bits)) * levels + size_t(colour[1] >> (8 - bits))) * levels +
        size_t(colour[2] >> (8 - bits));
    if (known_[cell] < 0) known_[cell] = int16_t(search(colour));
    return known_[cell];
  }

 private:
  int search(const std::array<int, 3>& colour) const {
    int best = 0, least = std::numeric_limits<int>::max();
    for (size_t i = 0; i < palette_.size(); ++i) {
      const int r = colour[0] - palette_[i].Red, g = colour[1] - palette_[i].Green,
                b = colour[2] - palette_[i].Blue;
      const int distance = 2 * r * r + 4 * g * g + b * b;
      if (distance >= least) continue;
      least = distance;
      best = int(i);
    }
    return best;
  }
  const std::vector<GifColorType>& palette_;
  std::vector<int16_t> known_;
};

std::vector<GifPixelType> dithered(std::span<const uint8_t> rgb, int width, int height,
                                   const std::vector<GifColorType>& palette) {
  std::vector<GifPixelType> out(size_t(width) * size_t(height));
  // quantization errors of the current and the next row, in sixteenths
  std::vector<std::array<int, 3>> here(size_t(width) + 2), below(size_t(width) + 2);
  Nearest nearest(palette);
  for (int y = 0; y < height; ++y) {
    std::swap(here, below);
    std::fill(below.begin(), below.end(), std::array<int, 3>{});
    for (int x = 0; x < width; ++x) {
      const size_t i = size_t(y) * size_t(width) + size_t(x);
      const auto column = size_t(x) + 1;
      std::array<int, 3> wanted;
      for (size_t k = 0; k < 3; ++k)
        wanted[k] = std::clamp(int(rgb[3 * i + k]) + (here[column][k] + 8) / 16, 0, 255);
      const int index = nearest(wanted);
      out[i] = GifPixelType(index);
      const GifColorType& got = palette[size_t(index)];
      const std::array<int, 3> error{wanted[0] - got.Red, wanted[1] - got.Green,
                                     wanted[2] - got.Blue};
      for (size_t k = 0; k < 3; ++k) {
        here[column + 1][k] += 7 * error[k];
        below[column - 1][k] += 3 * error[k];
        below[column][k] += 5 * error[k];
        below[column + 1][k] += error[k];
      }
    }
  }
  return out;
}

int append(GifFileType* gif, const GifByteType* bytes, int count) {
  try {
    static_cast<std::string*>(gif->UserData)
        ->append(reinterpret_cast<const char*>(bytes), size_t(count));
  } catch (const std::bad_alloc&) { return 0; }
  return count;
}

class GifEncoder : public FilmEncoder {
 public:
  GifEncoder(int width, int height, double fps, const std::string& note)
      : width_(width), height_(height), fps_(fps) {
    int error = 0;
    gif_ = EGifOpen(&bytes_, append, &error);
    if (!gif_) fail(error);
    EGifSetGifVersion(gif_, true);
    check(EGifPutScreenDesc(gif_, width, height, 8, 0, nullptr));
    // The Netscape extension makes the film loop.
    static constexpr unsigned char forEver[] = {1, 0, 0};
    check(EGifPutExtensionLeader(gif_, APPLICATION_EXT_FUNC_CODE));
    check(EGifPutExtensionBlock(gif_, 11, "NETSCAPE2.0"));
    check(EGifPutExtensionBlock(gif_, sizeof forEver, forEver));
    check(EGifPutExtensionTrailer(gif_));
    if (!note.empty()) check(EGifPutComment(gif_, note.c_str()));
  }
  ~GifEncoder() override {
    int error = 0;
    if (gif_) EGifCloseFile(gif_, &error);
  }

  void add(std::span<const uint8_t> rgb) override {
    std::vector<GifColorType> palette = medianCut(rgb);
    std::vector<GifPixelType> pixels = dithered(rgb, width_, height_, palette);
    palette.resize(maxColours);
    ColorMapObject* map = GifMakeMapObject(maxColours, palette.data());
    if (!map) throw std::bad_alloc();
    // GIF delays are in hundredths of a second. They differ by one, so that their sum does not
    // drift.
    const double end = std::round(double(++pictures_) * 100 / fps_), length = end - shown_;
    shown_ = end;
    GraphicsControlBlock control{DISPOSE_DO_NOT, false, int(std::clamp(length, 2.0, 65535.0)),
                                 NO_TRANSPARENT_COLOR};
    GifByteType extension[4];
    EGifGCBToExtension(&control, extension);
    bool good =
        EGifPutExtension(gif_, GRAPHICS_EXT_FUNC_CODE, sizeof extension, extension) == GIF_OK &&
        EGifPutImageDesc(gif_, 0, 0, width_, height_, false, map) == GIF_OK;
    GifFreeMapObject(map);
    for (int y = 0; good && y < height_; ++y)
      good = EGifPutLine(gif_, pixels.data() + size_t(y) * size_t(width_), width_) == GIF_OK;
    if (!good) fail(gif_->Error);
  }

  std::string finish() override {
    int error = 0;
    const bool good = EGifCloseFile(std::exchange(gif_, nullptr), &error) == GIF_OK;
    if (!good) fail(error);
    return std::move(bytes_);
  }

 private:
  [[noreturn]] static void fail(int error) {
    const char* const text = GifErrorString(error);
    throw std::runtime_error(fmt::format("giflib: {}", text ? text : "failed"));
  }
  void check(int result) {
    if (result != GIF_OK) fail(gif_->Error);
  }
  int width_, height_;
  double fps_, shown_ = 0; // shown_: hundredths of a second since the start
  size_t pictures_ = 0;
  std::string bytes_;
  GifFileType* gif_ = nullptr;
};

} // namespace

std::unique_ptr<FilmEncoder> makeGifEncoder(int width, int height, double fps,
                                            const std::string& note) {
  return std::make_unique<GifEncoder>(width, height, fps, note);
}

} // namespace picture
