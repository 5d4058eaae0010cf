// sliver_pieces.h: cuts the bounds of a sliver into pieces along its length. A long triangle in an
// odd direction has a large bounding box, most of which is empty; boxes of its pieces are met by
// fewer rays. Every piece stands for the whole triangle. Pure functions, called when a geometry is
// baked.
#pragma once

#include <cstdint>

#include "backend/local/accel/bake.h"

namespace openrt {

struct Piece {
  uint8_t number = 0, count = 1;
};

// Returns into how many pieces a triangle is cut: 1, 2, 4, 8 or 16.
uint8_t countPieces(const Vec3d& a, const Vec3d& b, const Vec3d& c);

// Returns the bounds of a piece of a triangle.
Box boundsOfPiece(const Vec3d& a, const Vec3d& b, const Vec3d& c, Piece piece);

// Returns whether a point belongs to a piece. Every point belongs to one piece.
bool isInPiece(const Vec3d& a, const Vec3d& b, const Vec3d& c, Piece piece, const Vec3d& point);

} // namespace openrt
