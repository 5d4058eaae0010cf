// spherical.h: triangles and ellipsoids as seen from a point: solid angles, and uniform sampling of
// directions towards them. Pure functions in double, used for light sampling
// (render/lights/emitters.h). [any]
#pragma once

#include <array>

#include "render/records.h"

namespace openrt {

// A triangle seen from a point. Solid angle: A. van Oosterom, J. Strackee, "The Solid Angle of a
// Plane Triangle", 1983, with the triple product computed from the edges, so that it stays accurate
// for triangles that look arbitrarily small. Sampling: J. Arvo, "Stratified Sampling of Spherical
// Triangles", SIGGRAPH 1995, in the form of C. Peters, "BRDF Importance Sampling for Polygonal
// Lights", SIGGRAPH 2021, without inverse cosines. A triangle at a large distance compared to its
// size is sampled uniformly by area: that is hardly noisier there, several times as fast, and
// accurate at any apparent size.
class SphericalTriangle {
 public:
  SphericalTriangle(const std::array<Vec3f, 3>& corner, const Vec3f& eye);
  // Returns 0 if the triangle is seen edge-on, has no area, or the eye is at one of its corners.
  double solidAngle() const;
  bool far() const { return far_; }
  // Samples a unit direction with pdf(direction), and the distance of the triangle along it.
  // Returns false if there is none.
  bool sample(double u, double v, Vec3d& direction, double& distance) const;
  // Returns the pdf by solid angle.
  double pdf(const Vec3d& direction) const;
  // Returns whether the eye is on the side from which the corners turn counter-clockwise.
  bool front() const { return height_ < 0; }

 private:
  void computeSolidAngle();
  double distanceAlong(const Vec3d& direction) const;
  // corner_: relative to the eye. normal_: its length is twice the area.
  Vec3d corner_[3], unit_[3], normal_;
  // volume_: triple product of the unit vectors. others_: AC + BC, first_: 1 + AB (dot
  // products of unit vectors).
  double volume_ = 0, others_ = 0, first_ = 0;
  // height_: corner_ . normal_: twice the area times the distance of the plane.
  double solidAngle_ = 0, height_ = 0;
  bool far_ = false;
};

// The unit sphere under an affine map, seen from outside: directions within the cone that touches
// it. If the eye is inside, no direction is sampled: every direction hits the surface, and BSDF
// sampling is better there.
class SphericalEllipsoid {
 public:
  // toLocal: the map into the frame in which it is the unit sphere. toRender: the inverse.
  SphericalEllipsoid(const Affine& toLocal, const Affine& toRender, const Vec3f& eye);
  bool inside() const { return inside_; }
  bool sample(double u, double v, Vec3d& direction, double& distance) const;
  double pdf(const Vec3d& direction) const; // by solid angle, for a direction that hits it

 private:
  Affine toLocal_, toRender_;
  double determinant_; // absolute determinant of toLocal
  // eye_: in the sphere's frame. cap_: 1 - cosine of the cone's half angle.
  Vec3d eye_;
  double cap_ = 0;
  bool inside_;
};

} // namespace openrt
