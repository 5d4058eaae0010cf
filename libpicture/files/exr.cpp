// exr.cpp: Encodes a picture as OpenEXR in memory: one part, 32-bit floats, ZIP. Planes are named
// as oiiotool and tev group them; the names for the numbers of channel id are a JSON object in the
// string attribute idNames. Nothing that changes from run to run is written. [any thread]
#include <stdexcept>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include "libpicture/files/cryptomatte.h"
#include "libpicture/files/formats.h"
#include "libpicture/files/json_text.h"
#include "openrt/openrt.h"

namespace picture {

namespace {

class MemoryStream : public Imf::OStream {
 public:
  explicit MemoryStream(std::string& out) : OStream("picture.exr"), out_(out) {}
  void write(const char bytes[], int count) override {
    if (position_ + size_t(count) > out_.size()) out_.resize(position_ + size_t(count));
    out_.replace(position_, size_t(count), bytes, size_t(count));
    position_ += size_t(count);
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }

 private:
  std::string& out_;
  size_t position_ = 0;
};

std::string nameTable(const std::vector<std::string>& names) {
  std::string text = "{";
  for (size_t i = 1; i < names.size(); ++i)
    if (!names[i].empty()) // the number belongs to no Shape
      text += fmt::format("{}\"{}\":{}", text.size() > 1 ? "," : "", i, jsonText(asUtf8(names[i])));
  return text + "}";
}

Imf::Header makeHeader(const Picture& picture) {
  Imf::Header header(picture.width, picture.height);
  if (picture.wholeWidth > 0) { // a part of a picture: its place in the whole
    header.displayWindow() = {{0, 0}, {picture.wholeWidth - 1, picture.wholeHeight - 1}};
    header.dataWindow() = {{picture.left, picture.top},
                           {picture.left + picture.width - 1, picture.top + picture.height - 1}};
  }
  header.compression() = Imf::ZIP_COMPRESSION;
  header.insert("software",
                Imf::StringAttribute(fmt::format("vv {}.{}.{}", OPENRT_VERSION_MAJOR,
                                                 OPENRT_VERSION_MINOR, OPENRT_VERSION_PATCH)));
  header.insert("colour", Imf::StringAttribute(picture.linear ? "linear" : "vrml97"));
  if (picture.linear) Imf::addChromaticities(header, Imf::Chromaticities()); // Rec. 709
  if (!picture.view.isPlain() && picture.linear) { // advice for who shows it; pixels stay linear
    header.insert("viewExposure", Imf::FloatAttribute(float(picture.view.exposure)));
    header.insert("viewCurve", Imf::StringAttribute(std::string(curveName(picture.view.curve))));
  }
  if (picture.planes.count(RT_DEPTH))
    header.insert("depthAlong", Imf::StringAttribute(picture.depthAlongRay ? "ray" : "axis"));
  if (!picture.note.empty()) Imf::addComments(header, picture.note);
  if (picture.planes.count(RT_NAME))
    header.insert("idNames", Imf::StringAttribute(nameTable(picture.names)));
  if (picture.planes.count(RT_COVERAGE))
    for (const auto& [key, value] : cryptomatteAttributes(picture))
      header.insert(key, Imf::StringAttribute(value));
  return header;
}

} // namespace

std::string encodeExr(const Picture& picture) {
  std::string out;
  try {
    Imf::Header header = makeHeader(picture);
    Imf::FrameBuffer frame;
    std::vector<float> layers; // the layers of Cryptomatte
    for (const Channel& channel : pictureChannels()) {
      auto plane = picture.planes.find(channel.bit);
      if (plane == picture.planes.end()) continue;
      if (channel.bit == RT_COVERAGE) layers = cryptomatteLayers(picture);
      const std::vector<float>& values = channel.bit == RT_COVERAGE ? layers : plane->second;
      const size_t pixel = size_t(channel.components) * sizeof(float);
      for (size_t c = 0; c < channel.exr.size(); ++c) {
        const std::string& name = channel.exr[c];
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        char* base = reinterpret_cast<char*>(const_cast<float*>(values.data() + c));
        const size_t row = pixel * size_t(picture.width);
        // OpenEXR addresses pixels relative to the display window.
        base -= picture.left * std::ptrdiff_t(pixel) + picture.top * std::ptrdiff_t(row);
        frame.insert(name, Imf::Slice(Imf::FLOAT, base, pixel, row));
      }
    }
    MemoryStream stream(out);
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(picture.height);
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string("OpenEXR: ") + error.what());
  }
  return out;
}

} // namespace picture
