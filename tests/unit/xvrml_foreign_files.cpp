// xvrml_foreign_files.cpp: writes the files of foreign_files.h.
#include "unit/foreign_files.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <sndfile.h>
#include <webp/encode.h>

namespace xvrml::test {
namespace {

class Output : public Imf::OStream {
 public:
  Output() : OStream("memory") {}
  void write(const char from[], int count) override {
    bytes.resize(std::max(bytes.size(), at_ + size_t(count)));
    std::copy_n(from, count, bytes.begin() + ptrdiff_t(at_));
    at_ += size_t(count);
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t at) override { at_ = at; }
  Bytes bytes;

 private:
  size_t at_ = 0;
};

Imf::Header headerOf(const ExrKind& kind, const std::string& channels) {
  const Imath::Box2i window({kind.left, kind.top},
                            {kind.left + kind.width - 1, kind.top + kind.height - 1});
  Imf::Header header(window, window);
  header.compression() = Imf::Compression(kind.compression);
  if (kind.upwards) header.lineOrder() = Imf::DECREASING_Y;
  for (const char name : channels)
    header.channels().insert(std::string(1, name),
                             Imf::Channel(kind.isFloat ? Imf::FLOAT : Imf::HALF));
  if (kind.tiled)
    header.setTileDescription({16, 8, kind.levels ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL});
  return header;
}

// Holds the numbers of a picture while they are written.
struct Planes {
  Planes(const ExrKind& kind, const std::string& channels) {
    const auto at = [&](size_t c, int x, int y) -> float& {
      return planes[c][size_t(y) * size_t(kind.width) + size_t(x)];
    };
    for (size_t c = 0; c < channels.size(); ++c) {
      planes.emplace_back(size_t(kind.width) * size_t(kind.height));
      const size_t colour = std::string("RGB").find(channels[c]);
      for (int y = 0; y < kind.height; ++y)
        for (int x = 0; x < kind.width; ++x)
          at(c, x, y) = channels[c] == 'Y'            ? radianceAt(x, y, 0)
                        : colour == std::string::npos ? -99.0f
                                                      : radianceAt(x, y, int(colour));
      halves.emplace_back(planes[c].begin(), planes[c].end());
      const size_t size = kind.isFloat ? sizeof(float) : sizeof(half);
      char* base = kind.isFloat ? reinterpret_cast<char*>(planes[c].data())
                                : reinterpret_cast<char*>(halves[c].data());
      base -= (kind.top * kind.width + kind.left) * ptrdiff_t(size);
      frame.insert(std::string(1, channels[c]), Imf::Slice(kind.isFloat ? Imf::FLOAT : Imf::HALF,
                                                           base, size, size * size_t(kind.width)));
    }
  }
  std::vector<std::vector<float>> planes;
  std::vector<std::vector<half>> halves;
  Imf::FrameBuffer frame;
};

void word(Bytes& to, uint32_t value, int count) {
  for (int i = 0; i < count; ++i) to.push_back(uint8_t(value >> 8 * i));
}

} // namespace

Bytes makeExr(const ExrKind& kind) {
  Output out;
  Planes planes(kind, kind.channels);
  const Imf::Header header = headerOf(kind, kind.channels);
  if (kind.tiled) {
    Imf::TiledOutputFile file(out, header);
    file.setFrameBuffer(planes.frame);
    for (int level = 0; level < file.numLevels(); ++level)
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  } else {
    Imf::OutputFile file(out, header);
    file.setFrameBuffer(planes.frame);
    file.writePixels(kind.height);
  }
  return out.bytes;
}

Bytes makeTwoParts(const ExrKind& kind) {
  Output out;
  {
    Imf::Header headers[] = {headerOf(kind, "Z"), headerOf(kind, "RGB")};
    for (Imf::Header& header : headers) {
      header.setType(Imf::SCANLINEIMAGE);
      header.setName(&header == headers ? "depth" : "beauty");
    }
    Imf::MultiPartOutputFile file(out, headers, 2);
    for (const int part : {0, 1}) {
      Planes planes(kind, part == 0 ? "Z" : "RGB");
      Imf::OutputPart output(file, part);
      output.setFrameBuffer(planes.frame);
      output.writePixels(kind.height);
    }
  }
  return out.bytes;
}

Bytes makeChroma(int width, int height, float red, float green, float blue) {
  Output out;
  {
    const std::vector<Imf::Rgba> pixels(size_t(width) * size_t(height), {red, green, blue, 1});
    Imf::RgbaOutputFile file(out, Imf::Header(width, height), Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, size_t(width));
    file.writePixels(height);
  }
  return out.bytes;
}

Bytes makeWebp(int width, int height, int components) {
  Bytes pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < components; ++c)
        pixels.push_back(c == 3 ? alphaAt(x, y) : byteAt(x, y, c));
  uint8_t* made = nullptr;
  const auto encode = components == 4 ? WebPEncodeLosslessRGBA : WebPEncodeLosslessRGB;
  const size_t size = encode(pixels.data(), width, height, width * components, &made);
  Bytes file(made, made + size);
  WebPFree(made);
  return file;
}

Bytes makeBmp(int width, int height, int components) {
  const uint32_t row = uint32_t(width * components + 3) / 4 * 4, size = row * uint32_t(height);
  Bytes file = {'B', 'M'};
  word(file, 54 + size, 4);
  word(file, 0, 4);
  word(file, 54, 4); // where the pixels are
  word(file, 40, 4);
  word(file, uint32_t(width), 4);
  word(file, uint32_t(height), 4);
  word(file, 1, 2);
  word(file, uint32_t(8 * components), 2);
  word(file, 0, 4); // not compressed
  word(file, size, 4);
  for (int i = 0; i < 4; ++i) word(file, 0, 4);
  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x)
      for (const int c : {2, 1, 0, 3})
        if (c < components) file.push_back(c == 3 ? alphaAt(x, y) : byteAt(x, y, c));
    for (uint32_t i = uint32_t(width * components); i < row; ++i) file.push_back(0);
  }
  return file;
}

Bytes makeTga(int width, int height, const TgaKind& kind) {
  Bytes file = {0, 0, uint8_t((kind.components == 1 ? 3 : 2) + (kind.runs ? 8 : 0)), 0, 0, 0, 0, 0};
  word(file, 0, 4);
  word(file, uint32_t(width), 2);
  word(file, uint32_t(height), 2);
  file.push_back(uint8_t(8 * kind.components));
  file.push_back(uint8_t((kind.components == 4 ? 8 : 0) | (kind.fromTop ? 0x20 : 0)));
  for (int i = 0; i < height; ++i)
    for (int x = 0; x < width; ++x) {
      const int y = kind.fromTop ? i : height - 1 - i;
      if (kind.runs) file.push_back(x % 2 == 0 ? 0 : 0x80); // one pixel, as it is or as a run
      for (const int c : {2, 1, 0, 3})
        if (kind.components == 1 ? c == 0 : c < kind.components) file.push_back(byteAt(x, y, c));
    }
  return file;
}

Bytes makeSound(int format, int frames) {
  struct Memory {
    Bytes bytes;
    sf_count_t at = 0;
  } memory;
  const auto of = [](void* user) -> Memory& { return *static_cast<Memory*>(user); };
  static const auto memoryOf = of;
  SF_VIRTUAL_IO access{
      [](void* user) { return sf_count_t(memoryOf(user).bytes.size()); },
      [](sf_count_t offset, int whence, void* user) {
        Memory& m = memoryOf(user);
        const sf_count_t from = whence == SEEK_SET   ? 0
                                : whence == SEEK_CUR ? m.at
                                                     : sf_count_t(m.bytes.size());
        return m.at = from + offset;
      },
      [](void* to, sf_count_t count, void* user) {
        Memory& m = memoryOf(user);
        const sf_count_t got = std::clamp<sf_count_t>(count, 0, sf_count_t(m.bytes.size()) - m.at);
        std::copy_n(m.bytes.begin() + m.at, got, static_cast<uint8_t*>(to));
        m.at += got;
        return got;
      },
      [](const void* from, sf_count_t count, void* user) {
        Memory& m = memoryOf(user);
        m.bytes.resize(std::max(m.bytes.size(), size_t(m.at + count)));
        std::copy_n(static_cast<const uint8_t*>(from), count, m.bytes.begin() + m.at);
        m.at += count;
        return count;
      },
      [](void* user) { return memoryOf(user).at; }};
  SF_INFO info{0, 44100, 1, format, 0, 0};
  SNDFILE* file = sf_open_virtual(&access, SFM_WRITE, &info, &memory);
  if (!file) return {};
  std::vector<float> samples;
  for (int i = 0; i < frames; ++i)
    samples.push_back(0.5f * std::sin(float(i) * 440 * 2 * 3.14159265f / 44100));
  sf_writef_float(file, samples.data(), frames);
  sf_close(file);
  return memory.bytes;
}

} // namespace xvrml::test
