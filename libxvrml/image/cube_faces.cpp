// cube_faces.cpp: cuts pictures of unfolded cubes into their faces.
#include "image/cube_faces.h"

#include <algorithm>
#include <stdexcept>

#include "image/decoders.h"

namespace xvrml {
namespace {

// The place of a face in an unfolded cube, in faces from the upper left. halfTurn: it is upside
// down there.
struct Cut {
  CubeFace face;
  int column, row;
  bool halfTurn = false;
};
struct Layout {
  int columns, rows;
  Cut cuts[cubeFaces];
};
constexpr Layout layouts[] = {{4,
                               3,
                               {{CubeFace::front, 1, 1},
                                {CubeFace::back, 3, 1},
                                {CubeFace::left, 0, 1},
                                {CubeFace::right, 2, 1},
                                {CubeFace::top, 1, 0},
                                {CubeFace::bottom, 1, 2}}},
                              {3,
                               4,
                               {{CubeFace::front, 1, 1},
                                {CubeFace::back, 1, 3, true},
                                {CubeFace::left, 0, 1},
                                {CubeFace::right, 2, 1},
                                {CubeFace::top, 1, 0},
                                {CubeFace::bottom, 1, 2}}}};

std::vector<uint8_t>& numbersOf(Image& image) { return image.pixels; }
const std::vector<uint8_t>& numbersOf(const Image& image) { return image.pixels; }
std::vector<float>& numbersOf(RadianceImage& image) { return image.rgb; }
const std::vector<float>& numbersOf(const RadianceImage& image) { return image.rgb; }
size_t perPixel(const Image& image) { return size_t(image.components); }
size_t perPixel(const RadianceImage&) { return 3; }
void like(const Image& from, Image& to) { to.components = from.components; }
void like(const RadianceImage&, RadianceImage&) {}

template <class Picture> Picture cutOut(const Picture& all, const Layout& layout, const Cut& cut) {
  Picture face;
  like(all, face);
  const int side = all.width / layout.columns;
  face.width = face.height = side;
  const size_t n = perPixel(all);
  auto& to = numbersOf(face);
  to.resize(size_t(side) * size_t(side) * n);
  const int bottom = (layout.rows - 1 - cut.row) * side, left = cut.column * side; // rows go up
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int fromX = left + (cut.halfTurn ? side - 1 - x : x),
                fromY = bottom + (cut.halfTurn ? side - 1 - y : y);
      std::copy_n(&numbersOf(all)[(size_t(fromY) * size_t(all.width) + size_t(fromX)) * n], n,
                  &to[(size_t(y) * size_t(side) + size_t(x)) * n]);
    }
  return face;
}

template <class Picture> std::vector<Picture> cut(Picture picture) {
  std::vector<Picture> pictures;
  for (const Layout& layout : layouts) {
    if (picture.width / layout.columns != picture.height / layout.rows ||
        picture.width % layout.columns != 0 || picture.height % layout.rows != 0)
      continue;
    pictures.resize(cubeFaces);
    for (const Cut& one : layout.cuts) pictures[size_t(one.face)] = cutOut(picture, layout, one);
    return pictures;
  }
  pictures.push_back(std::move(picture));
  return pictures;
}

} // namespace

CubePictures decodeCube(std::span<const uint8_t> bytes, const ImageRoom& room) {
  if (looksLikeDds(bytes)) return decodeDds(bytes, room);
  CubePictures pictures;
  if (looksLikeRadiance(bytes.data(), bytes.size()))
    pictures.radiance = cut(decodeRadiance(bytes, room));
  else
    pictures.images = cut(decodeImage(bytes.data(), bytes.size(), room));
  return pictures;
}

} // namespace xvrml
