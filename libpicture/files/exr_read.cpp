// exr_read.cpp: Reads the colours of an OpenEXR file for comparisons, and other channels of it if
// it has any. The user names these files on the command line; a file named by a world is never read
// here. [any thread]
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <stdexcept>

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>
#include <unistd.h>

#include "libpicture/files/picture.h"
#include "lower_case.h"
#include "openrt/openrt.h"
#include "picture_size.h"
#include "printable.h"

namespace picture {

namespace {

// A channel that a file has, and the names of its planes there.
struct Found {
  const Channel* channel;
  std::vector<std::string> planes;
};

// Returns the name of a plane in the file; programs write "variance.R" or "Variance.R". Returns ""
// if there is none.
std::string nameIn(const Imf::ChannelList& list, const std::string& name) {
  if (list.findChannel(name)) return name;
  for (auto one = list.begin(); one != list.end(); ++one)
    if (lowerCase(one.name()) == lowerCase(name)) return one.name();
  return "";
}

// Returns the wanted channels that the file has. Throws std::runtime_error if there are no colours.
std::vector<Found> findChannels(const Imf::ChannelList& list, uint32_t wanted) {
  std::vector<Found> all;
  for (const Channel& channel : channelTable()) {
    if (!(channel.bit & wanted) || nameIn(list, channel.exr[0]).empty()) continue;
    Found found{&channel, {}};
    for (const std::string& plane : channel.exr) {
      const std::string name = nameIn(list, plane);
      found.planes.push_back(name.empty() ? plane : name); // one that is missing is filled
    }
    all.push_back(std::move(found));
  }
  if (!all.empty() && all[0].channel->bit == RT_RGBA) return all;
  constexpr size_t most = 6;
  std::string names;
  size_t count = 0;
  for (auto one = list.begin(); one != list.end() && count < most; ++one, ++count)
    names += (names.empty() ? "" : ", ") + printable(one.name());
  throw std::runtime_error(fmt::format("there is no channel R; it has {}{}", names,
                                       count == most ? " and perhaps others" : ""));
}

// Appends `rows` rows, starting at row y, to the planes of these channels.
void readRows(Imf::InputFile& file, const Imath::Box2i& window, const std::vector<Found>& channels,
              int64_t y, int64_t rows, Picture& picture) {
  Imf::FrameBuffer frame;
  for (const auto& [channel, planes] : channels) {
    std::vector<float>& plane = picture.planes[channel->bit];
    const size_t pixel = size_t(channel->components) * sizeof(float),
                 row = pixel * size_t(picture.width);
    plane.resize(size_t(picture.width) * size_t(y + rows) * size_t(channel->components));
    for (size_t c = 0; c < planes.size(); ++c) {
      char* base = reinterpret_cast<char*>(plane.data() + c);
      // OpenEXR addresses pixels relative to the data window, whose corner may be anywhere.
      base -= std::ptrdiff_t(window.min.x) * std::ptrdiff_t(pixel) +
              std::ptrdiff_t(window.min.y) * std::ptrdiff_t(row);
      frame.insert(planes[c], Imf::Slice(Imf::FLOAT, base, pixel, row, 1, 1, c == 3 ? 1.0 : 0.0));
    }
  }
  file.setFrameBuffer(frame);
  file.readPixels(int(window.min.y + y), int(window.min.y + y + rows - 1));
}

} // namespace

InputError::InputError(const std::string& file, std::string_view why)
    : runtime_error([&] {
        // the beginning of OpenEXR's messages
        const std::string opening = fmt::format("Cannot read image file \"{}\". ", file);
        for (const std::string& start : {opening, file + ": "})
          if (why.starts_with(start)) why.remove_prefix(start.size());
        return fmt::format("cannot read {}: {}", file, why);
      }()),
      path(file) {}

Picture readExr(const std::string& path) { return readExr(path, RT_RGBA | RT_ERROR | RT_TRUST); }

Picture readExr(const std::string& path, uint32_t wanted) {
  if (::access(path.c_str(), R_OK) != 0) throw InputError(path, std::strerror(errno));
  try {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1,
                  height = int64_t(window.max.y) - window.min.y + 1;
    if (!isPictureSize(width, height))
      throw std::runtime_error(fmt::format("{} x {} pixels", width, height));
    Picture picture;
    picture.width = int(width);
    picture.height = int(height);
    if (Imf::hasComments(file.header())) picture.note = printable(Imf::comments(file.header()));
    const std::vector<Found> channels = findChannels(file.header().channels(), wanted);
    // The planes grow as rows are read, so a small file whose header claims a large picture costs
    // little.
    constexpr int64_t pixelsAtOnce = 1 << 20;
    // one block of the tallest compression has 256 rows
    const int64_t rowsAtOnce = std::max<int64_t>(pixelsAtOnce / width, 256);
    for (int64_t y = 0; y < height; y += rowsAtOnce) {
      const int64_t rows = std::min(rowsAtOnce, height - y);
      readRows(file, window, channels, y, rows, picture);
    }
    return picture;
  } catch (const std::bad_alloc&) { throw; } catch (const std::exception& error) {
    throw InputError(path, error.what());
  }
}

} // namespace picture
