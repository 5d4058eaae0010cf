// spherical.h: triangles and ellipsoids as seen from a point: their solid angles, and directions
// spread evenly over them. Pure functions in double, for the choice of places on lights
// (render/lights/emitters.h). [any]
#pragma once

#include <cmath>

namespace openrt {

// A triangle seen from a point. Solid angle: A. van Oosterom, J. Strackee, "The Solid Angle of a
// Plane Triangle", 1983, with the triple product taken of the edges, so that it keeps its digits
// however small the triangle looks. Sampling: J. Arvo, "Stratified Sampling of Spherical
// Triangles", SIGGRAPH 1995, in the form of C. Peters, "BRDF Importance Sampling for Polygonal
// Lights", SIGGRAPH 2021, which has no inverse cosines. A triangle that is thrice as far away as it
// is long is sampled evenly over its area: that is hardly noisier there, several times as fast, and
// as exact however small it looks.
class SphericalTriangle {
 public:
  SphericalTriangle(const float corner[3][3], const float eye[3]);
  // 0: seen edge-on, without area, or from one of its corners.
  double solidAngle() const;
  bool far() const { return far_; }
  // A unit direction of density density(direction), and the distance of the triangle along it.
  // False: none.
  bool sample(double u, double v, double direction[3], double& distance) const;
  // By solid angle.
  double density(const double direction[3]) const;
  bool front() const {
    return height_ < 0;
  } // the eye is on the side from which the corners turn counter-clockwise
  // Whether a ray along the direction, rounded to float, may pass an edge.
  bool atRim(const double direction[3], double distance) const;

 private:
  void look();
  double distanceAlong(const double direction[3]) const;
  double corner_[3][3], unit_[3][3],
      normal_[3]; // corner_ from the eye; normal_ as long as twice the area
  double volume_ = 0, others_ = 0,
         first_ = 0; // triple product of the unit vectors; AC + BC; 1 + AB (dot products)
  double solidAngle_ = 0,
         height_ =
             0; // height_: corner_ . normal_, twice the area's times the distance of the plane
  bool far_ = false;
};

// The unit sphere under an affine map seen from outside: the cone that touches it. From inside
// there is nothing to choose: every direction meets it, and a surface's own directions are the
// better ones.
class SphericalEllipsoid {
 public:
  // toLocal: rows of the map into the frame in which it is the unit sphere; toRender: of its
  // inverse.
  SphericalEllipsoid(const float toLocal[3][4], const float toRender[3][4], const float eye[3]);
  bool inside() const { return inside_; }
  bool sample(double u, double v, double direction[3], double& distance) const;
  double density(const double direction[3]) const; // by solid angle, of a direction that meets it

 private:
  double toLocal_[3][3], toRender_[3][3], determinant_; // of toLocal
  double eye_[3], cap_ = 0; // eye_ in the sphere's frame; cap_: 1 - cosine of the cone
  bool inside_;
};

} // namespace openrt
