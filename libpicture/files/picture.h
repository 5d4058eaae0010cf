// picture.h: Holds a rendered picture in memory, with its channels, and converts it to what a
// screen shows. formats.h encodes it. The renderer's caller owns the picture. [any thread]
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/files/view_transform.h"

namespace picture {

// One channel of a frame, as rtGetChannelInfo describes it.
struct Channel {
  std::string_view name; // on the command line and in Python
  uint32_t bit;
  int components;               // floats per pixel
  std::vector<std::string> exr; // the names of its planes in OpenEXR files
  bool isWhole;                 // it has counts or numbers of Shapes
  bool hasNames;                // it has numbers of Shapes
  std::string_view text;        // RTchannelInfo::text; "": the name says enough
};
const std::vector<Channel>& channelTable();
const Channel* findChannel(std::string_view name);
// The same, with those that are made of finished pictures: doubt (libpicture/doubt.h). Pictures and
// files may have them, and no frame can be asked for them.
const std::vector<Channel>& pictureChannels();
const Channel* findPictureChannel(std::string_view name);
// Returns whether one of the channels has numbers of Shapes.
bool hasNames(uint32_t channels);

// All of a picture but its pixels.
struct PictureFacts {
  int width = 0, height = 0;
  bool linear = true;         // true: rgba is linear radiance; false: rgba holds display values
  bool depthAlongRay = false; // channel z is the distance along the ray, not along the view axis
  ViewTransform view;         // how linear rgba is shown on screens
  bool transparent = false;   // files of the picture have alpha if their format keeps it
  // display values of what screens show behind the shapes, by alpha; rgba does not have it
  std::optional<std::array<float, 3>> backdrop;
  // The picture is a part of a larger one of this size: its left upper corner there. Not of a
  // larger one: 0.
  int wholeWidth = 0, wholeHeight = 0, left = 0, top = 0;
  std::vector<std::string> names; // names for the numbers of Shapes; names[0] is ""
  // Holds what files of the picture say about it, a line of ASCII; "": nothing. Formats without
  // Format::keepsNote do not say it.
  std::string note;
  // The library that has denoised rgba (libpicture/denoiser.h); "": none has.
  std::string denoisedBy;
};

struct Picture : PictureFacts {
  // Indexed by Channel::bit; width*height*components floats, first row at the top.
  std::map<uint32_t, std::vector<float>> planes;
};

// Gives a picture these channels: makes a plane of its size for each, in the order of the table.
// fill(channel, plane) returns whether it could fill the plane; if not, no further one is made.
template <class Fill> bool fillChannels(Picture& picture, uint32_t channels, const Fill& fill) {
  for (const Channel& channel : channelTable()) {
    if (!(channels & channel.bit)) continue;
    std::vector<float>& plane = picture.planes[channel.bit];
    plane.resize(size_t(picture.width) * size_t(picture.height) * size_t(channel.components));
    if (!fill(channel.bit, plane)) return false;
  }
  return true;
}

// Returns the picture with those of its channels that are named, and without names that none of
// them has.
Picture withChannels(const Picture& picture, uint32_t channels);

// Keeps a rectangle of the pixels of a whole picture, which must lie within it.
void cut(Picture& picture, int x, int y, int width, int height);

// Returns the plane rgba. Throws std::runtime_error if the picture has none.
const std::vector<float>& rgbaOf(const Picture& picture);

// Returns 8-bit red, green, blue as a screen shows them, first row at the top.
std::vector<uint8_t> displayBytes(const Picture& picture);
// Returns the same without the backdrop, for programs that read the picture.
std::vector<uint8_t> displayBytesAlone(const Picture& picture);
// Also returns alpha; the colours are not premultiplied.
std::vector<uint8_t> displayBytesAlpha(const Picture& picture);

// A file that the user named cannot be read. The text is "cannot read PATH: WHY".
struct InputError : std::runtime_error {
  // Removes the path from the start of `why`, so that the text names the file once.
  InputError(const std::string& file, std::string_view why);
  std::string path;
};

// Reads rgba of an OpenEXR file, and error and trust if it has them. Throws InputError.
Picture readExr(const std::string& path);
// Reads rgba, and those of the channels that the file has. Names of channels may be in any case.
Picture readExr(const std::string& path, uint32_t channels);

// Reads a picture in any format that worlds may name, or any OpenEXR file with the channels R, G
// and B. Colours of 8 bits are display values (Picture::linear is false) and are not premultiplied.
// channels: those that an OpenEXR file may have besides rgba. Throws InputError.
Picture readPicture(const std::string& path, uint32_t channels);

} // namespace picture
