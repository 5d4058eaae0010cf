// sliver_pieces.cpp: bounds of the pieces of a triangle (sliver_pieces.h). A piece is the part
// between two planes across the longest axis of the triangle's bounds.
#include "backend/local/sliver_pieces.h"

#include <algorithm>

namespace openrt {
namespace {

constexpr uint8_t mostPieces = 16;
// Twice as many pieces must have less than this share of the surface, or they are not worth their
// memory.
constexpr double worthwhile = 0.75;

// Returns half the surface of a box, to which the number of rays that meet it is proportional.
double surfaceOf(const Box& box) {
  const Vec3d size = box.high - box.low;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

Box boundsOfTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  Box box;
  for (const Vec3d& p : {a, b, c}) box.add(p);
  return box;
}

size_t longestAxis(const Vec3d& size) {
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

double surfaceOfPieces(const Vec3d& a, const Vec3d& b, const Vec3d& c, uint8_t count) {
  double sum = 0;
  for (uint8_t i = 0; i < count; i++) sum += surfaceOf(boundsOfPiece(a, b, c, {i, count}));
  return sum;
}

} // namespace

uint8_t countPieces(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  uint8_t count = 1;
  double surface = surfaceOfPieces(a, b, c, count);
  while (count < mostPieces) {
    const double less = surfaceOfPieces(a, b, c, uint8_t(2 * count));
    if (!(less < worthwhile * surface)) break;
    count = uint8_t(2 * count);
    surface = less;
  }
  return count;
}

Box boundsOfPiece(const Vec3d& a, const Vec3d& b, const Vec3d& c, Piece piece) {
  const Box whole = boundsOfTriangle(a, b, c);
  if (piece.count == 1) return whole;
  const Vec3d size = whole.high - whole.low;
  const size_t axis = longestAxis(size);
  const auto planeAt = [&](int i) { return whole.low[axis] + size[axis] * i / piece.count; };
  const double begin = planeAt(piece.number), end = planeAt(piece.number + 1);
  Box box;
  const auto clip = [&](const Vec3d& p, const Vec3d& q) {
    if (p[axis] >= begin && p[axis] <= end) box.add(p);
    for (const double plane : {begin, end})
      if ((p[axis] < plane) != (q[axis] < plane))
        box.add(p + (q - p) * ((plane - p[axis]) / (q[axis] - p[axis])));
  };
  clip(a, b);
  clip(b, c);
  clip(c, a);
  return box;
}

bool isInPiece(const Vec3d& a, const Vec3d& b, const Vec3d& c, Piece piece, const Vec3d& point) {
  const Box whole = boundsOfTriangle(a, b, c);
  const size_t axis = longestAxis(whole.high - whole.low);
  const double share = (point[axis] - whole.low[axis]) / (whole.high[axis] - whole.low[axis]);
  // A share that is not a number belongs to the first piece.
  const int last = piece.count - 1,
            number = share > 0 ? int(std::min(share * piece.count, double(last))) : 0;
  return number == piece.number;
}

} // namespace openrt
