// exr_read.cpp: the colours of an OpenEXR file, for comparisons, and its error bars if it has any. Files are the user's own,
// named on the command line; never one that a world names. [any thread]
#include <stdexcept>

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include "openrt/openrt.h"
#include "picture/picture.h"

namespace picture {

Picture readExr(const std::string& path) {
  try {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1, height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > 65536 || height > 65536 || width * height > (int64_t(1) << 28))
      throw std::runtime_error(fmt::format("{} x {} pixels", width, height));
    Picture picture;
    picture.width = int(width), picture.height = int(height);
    Imf::FrameBuffer frame;
    for (const Channel& channel : channelTable()) {
      if (!(channel.bit & (RT_RGBA | RT_ERROR | RT_TRUST)) || !file.header().channels().findChannel(channel.exr[0].data()))
        continue;
      std::vector<float>& plane = picture.planes[channel.bit];
      plane.resize(size_t(width) * size_t(height) * size_t(channel.components));
      const size_t pixel = size_t(channel.components) * sizeof(float), row = pixel * size_t(width);
      for (int c = 0; c < channel.components; ++c) {
        char* base = reinterpret_cast<char*>(plane.data() + c);
        // OpenEXR counts from the window's corner on, which may be anywhere.
        base -= std::ptrdiff_t(window.min.x) * std::ptrdiff_t(pixel) + std::ptrdiff_t(window.min.y) * std::ptrdiff_t(row);
        frame.insert(std::string(channel.exr[c]), Imf::Slice(Imf::FLOAT, base, pixel, row, 1, 1, c == 3 ? 1.0 : 0.0));
      }
    }
    if (!picture.planes.count(RT_RGBA)) throw std::runtime_error("there is no channel R");
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return picture;
  } catch (const std::exception& error) { throw std::runtime_error(fmt::format("{}: {}", path, error.what())); }
}

} // namespace picture
