// open_exr.cpp: decodes OpenEXR pictures with OpenEXR's library: scan lines and tiles, all
// compressions, the first part with colours of a file with several.
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <fmt/format.h>

#include "answer.h"

namespace xvrml::decoding {
namespace {

using Bytes = std::span<const uint8_t>;
using Imath::Box2i;

constexpr const char* nameInMessages = "the file";
constexpr int largestSide = 65536, largestTile = 16384;
constexpr int64_t pixelsAtOnce = 1 << 20;

class FileInMemory : public Imf::IStream {
 public:
  explicit FileInMemory(Bytes bytes) : IStream(nameInMessages), bytes_(bytes) {}
  bool read(char to[], int count) override {
    if (count < 0 || uint64_t(count) > bytes_.size() - at_)
      throw Iex::InputExc("the file ends too early");
    std::copy_n(bytes_.begin() + ptrdiff_t(at_), count, to);
    at_ += uint64_t(count);
    return at_ < bytes_.size();
  }
  uint64_t tellg() override { return at_; }
  void seekg(uint64_t at) override { at_ = std::min<uint64_t>(at, bytes_.size()); }

 private:
  Bytes bytes_;
  uint64_t at_ = 0;
};

// How the colours of a part are stored.
enum class Colours { none, rgb, grey, chroma };

Colours coloursOf(const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type())) return Colours::none;
  const Imf::ChannelList& list = header.channels();
  if (list.findChannel("R") && list.findChannel("G") && list.findChannel("B")) return Colours::rgb;
  if (!list.findChannel("Y")) return Colours::none;
  return list.findChannel("RY") && list.findChannel("BY") ? Colours::chroma : Colours::grey;
}

std::string channelNames(const Imf::Header& header) {
  constexpr int most = 6;
  std::string names;
  int count = 0;
  for (auto one = header.channels().begin(); one != header.channels().end(); ++one)
    if (++count <= most) names += (names.empty() ? "" : ", ") + std::string(one.name());
  return count > most ? names + " and others" : names;
}

// Reads rows of a picture into three floats per pixel.
class Rows {
 public:
  Rows(Imf::MultiPartInputFile& file, Bytes bytes, int part, Colours colours)
      : colours_(colours), part_(file, part), copy_(bytes) {
    window_ = part_.header().dataWindow();
    if (colours != Colours::chroma) return;
    // The library computes colours from luminance and chroma. Its interface for that opens the file
    // again, and knows the first part only.
    if (part != 0) throw std::runtime_error("luminance and chroma in a further part are not read");
    rgba_ = std::make_unique<Imf::RgbaInputFile>(copy_, 0);
  }
  int64_t width() const { return int64_t(window_.max.x) - window_.min.x + 1; }
  int64_t height() const { return int64_t(window_.max.y) - window_.min.y + 1; }

  const std::vector<float>& read(int64_t from, int64_t count) {
    rows_.assign(size_t(width() * count * 3), 0.0f);
    const Box2i block({window_.min.x, int(window_.min.y + from)},
                      {window_.max.x, int(window_.min.y + from + count - 1)});
    if (colours_ == Colours::chroma)
      readChroma(block);
    else
      readChannels(block);
    return rows_;
  }

 private:
  void readChannels(const Box2i& block) {
    const size_t pixel = 3 * sizeof(float), row = pixel * size_t(width());
    static constexpr const char* names[] = {"R", "G", "B"};
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < (colours_ == Colours::grey ? 1 : 3); ++c)
      frame.insert(colours_ == Colours::grey ? "Y" : names[c],
                   Imf::Slice::Make(Imf::FLOAT, rows_.data() + c, block, pixel, row));
    part_.setFrameBuffer(frame);
    part_.readPixels(block.min.y, block.max.y);
    for (size_t i = 0; colours_ == Colours::grey && i < rows_.size(); i += 3)
      rows_[i + 1] = rows_[i + 2] = rows_[i];
  }
  void readChroma(const Box2i& block) {
    std::vector<Imf::Rgba> pixels(rows_.size() / 3);
    const ptrdiff_t across = ptrdiff_t(width());
    rgba_->setFrameBuffer(pixels.data() - block.min.x - block.min.y * across, 1, size_t(across));
    rgba_->readPixels(block.min.y, block.max.y);
    for (size_t i = 0; i < pixels.size(); ++i) {
      rows_[3 * i] = pixels[i].r;
      rows_[3 * i + 1] = pixels[i].g;
      rows_[3 * i + 2] = pixels[i].b;
    }
  }

  Colours colours_;
  Imf::InputPart part_;
  FileInMemory copy_;
  std::unique_ptr<Imf::RgbaInputFile> rgba_;
  Box2i window_;
  std::vector<float> rows_;
};

void decode(Bytes bytes, Answer& answer) {
  Imf::Header::setMaxImageSize(largestSide, largestSide);
  Imf::Header::setMaxTileSize(largestTile, largestTile);
  FileInMemory stream(bytes);
  Imf::MultiPartInputFile file(stream, 0);
  int part = 0;
  while (part < file.parts() && coloursOf(file.header(part)) == Colours::none) ++part;
  if (part == file.parts())
    throw std::runtime_error(fmt::format("there are no channels R, G and B and none Y, but {}",
                                         channelNames(file.header(0))));
  Rows rows(file, bytes, part, coloursOf(file.header(part)));
  answer.contents({uint64_t(rows.width()), uint64_t(rows.height()), 3, sizeof(float), 0});
  const int64_t most = std::max<int64_t>(pixelsAtOnce / rows.width(), 1);
  for (int64_t y = 0; y < rows.height(); y += most) {
    const std::vector<float>& read = rows.read(y, std::min(most, rows.height() - y));
    answer.add(read.data(), read.size() * sizeof(float));
  }
}

} // namespace

// The library begins its messages with what it could not do, and with the name of the file, which
// the message of the world has as well.
void decodeOpenExr(Bytes bytes, Answer& answer) try {
  decode(bytes, answer);
} catch (const Iex::BaseExc& error) {
  const std::string why = error.what(), opening = fmt::format("\"{}\". ", nameInMessages);
  const size_t at = why.find(opening);
  throw std::runtime_error(at == why.npos ? why : why.substr(at + opening.size()));
}

} // namespace xvrml::decoding
