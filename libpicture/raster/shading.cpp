#include "libpicture/raster/shading.h"

#include <array>
#include <cmath>

namespace picture::raster {

using xvrml::Color;

namespace {

Color product(const Color& a, const Color& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }

void add(Color& sum, const Color& more, float factor) {
  sum.r += factor * more.r;
  sum.g += factor * more.g;
  sum.b += factor * more.b;
}

// Returns the colour of a vertex as the picture adds colours.
Color vertexColor(const Mesh& mesh, size_t vertex) {
  const Color code = mesh.vertices.local().color(vertex);
  return mesh.look.linear ? linearOf(code) : code;
}

// Returns the weights of the corners of a triangle at a point of its plane. They are at least 0 and
// add up to 1. normal: the cross product of two edges.
std::array<double, 3> weightsAt(const Vec& p, const Vec corners[3], const Vec& normal) {
  const Vec &a = corners[0], &b = corners[1], &c = corners[2];
  const Vec fromA = p + a * -1.0;
  const double area = dot(normal, normal);
  const double second = dot(cross(fromA, c + a * -1.0), normal) / area,
               third = dot(cross(b + a * -1.0, fromA), normal) / area;
  std::array<double, 3> weights = {1 - second - third, second, third};
  double sum = 0;
  for (double& weight : weights) {
    weight = weight > 0 ? weight : 0; // also for a number that is none
    sum += weight;
  }
  for (double& weight : weights) weight = sum > 0 && std::isfinite(sum) ? weight / sum : 1.0 / 3;
  return weights;
}

// Thresholds of ordered dithering (Bayer 1973), by the place of a pixel.
float threshold(uint32_t x, uint32_t y) {
  static constexpr uint8_t order[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  return (float(order[(y & 3) * 4 + (x & 3)]) + 0.5f) / 16;
}

} // namespace

// A point of a triangle.
struct Shading::Point {
  std::array<uint32_t, 3> corners;
  std::array<double, 3> weights;
  Vec place, toEye, normal; // two unit vectors; the normal is that of the side that is seen
  Textures::Sample picture; // white where there is none
};

Shading::Point Shading::pointAt(const Mesh& mesh, size_t triangle, double x, double y) const {
  Point point;
  point.corners = mesh.vertices.triangle(triangle);
  const Eye::Ray ray = eye_.ray(x, y);
  const Vec corners[3] = {mesh.vertices.place(point.corners[0]),
                          mesh.vertices.place(point.corners[1]),
                          mesh.vertices.place(point.corners[2])};
  const Vec face = cross(corners[1] + corners[0] * -1.0, corners[2] + corners[0] * -1.0);
  const double t = dot(face, corners[0] + ray.origin * -1.0) / dot(face, ray.direction);
  point.weights = weightsAt(ray.origin + ray.direction * t, corners, face);
  Vec normal = face;
  if (mesh.vertices.local().hasNormals()) normal = {};
  for (int i = 0; i < 3; ++i) {
    const double weight = point.weights[size_t(i)];
    point.place = point.place + corners[i] * weight;
    if (!mesh.vertices.local().hasNormals()) continue;
    const xvrml::Vec3f n = mesh.vertices.normal(point.corners[size_t(i)]);
    normal = normal + Vec{n.x, n.y, n.z} * weight;
  }
  const bool back = dot(face, ray.direction) > 0;
  point.normal = unit(normal) * (back ? -1.0 : 1.0);
  point.toEye = unit(ray.direction) * -1.0;
  if (const auto& picture = mesh.look.surface.picture) {
    double s = 0, v = 0;
    for (int i = 0; i < 3; ++i) {
      const xvrml::Vec2f uv = mesh.vertices.local().texCoord(point.corners[size_t(i)]);
      s += point.weights[size_t(i)] * uv.x;
      v += point.weights[size_t(i)] * uv.y;
    }
    point.picture = textures_.sample(*picture, s, v);
  }
  return point;
}

bool Shading::coversPixel(const Mesh& mesh, size_t triangle, int x, int y) const {
  const Surface& surface = mesh.look.surface;
  const Point point = pointAt(mesh, triangle, x + 0.5, y + 0.5);
  float alpha = surface.opacity * point.picture.alpha;
  if (surface.showsVertexColors && mesh.vertices.local().hasAlphas()) {
    double share = 0;
    for (size_t i = 0; i < 3; ++i)
      share += point.weights[i] * mesh.vertices.local().alpha(point.corners[i]);
    alpha *= float(share);
  }
  if (surface.alpha == Surface::Alpha::mask) return alpha >= surface.alphaCutoff;
  // Shapes one behind the other are drawn in different pixels.
  return alpha > threshold(uint32_t(x) + mesh.number, uint32_t(y) + mesh.number / 4);
}

Color Shading::seen(const Mesh& mesh, const Color& color, const Vec& point) const {
  const Haze* haze = mesh.look.haze;
  return haze ? haze->over(color, length(point + eye_.position() * -1.0)) : color;
}

Color Shading::lit(const Mesh& mesh, const Point& point, const Color& diffuse) const {
  const Surface& surface = mesh.look.surface;
  Color sum = surface.emission;
  for (const Lamp* lamp : mesh.lamps) {
    const Incident light = lamp->incidentAt(point.place);
    const double cosine = dot(point.normal, light.toLight);
    add(sum, product(light.ambient, diffuse), mesh.look.ambient);
    if (!(cosine > 0)) continue;
    const float factor = surface.takesIrradiance ? lamp->irradianceFactor() : 1;
    add(sum, product(light.direct, diffuse), factor * float(cosine));
    if (surface.isMatt) continue;
    const double shine = dot(point.normal, unit(light.toLight + point.toEye));
    if (shine > 0)
      add(sum, product(light.direct, surface.specular),
          factor * std::pow(float(shine), surface.exponent));
  }
  return sum;
}

Color Shading::colorAt(const Mesh& mesh, size_t triangle, double x, double y) const {
  const Surface& surface = mesh.look.surface;
  const Point point = pointAt(mesh, triangle, x, y);
  Color base = product(surface.color, point.picture.color);
  if (surface.showsVertexColors) {
    Color mixed;
    for (size_t i = 0; i < 3; ++i)
      add(mixed, vertexColor(mesh, point.corners[i]), float(point.weights[i]));
    base = product(base, mixed);
  }
  return seen(mesh, surface.lit ? lit(mesh, point, base) : base, point.place);
}

Color Shading::colorOnLine(const Mesh& mesh, size_t first, size_t second, double t) const {
  const size_t ends[2] = {mesh.index(first), mesh.index(second)};
  const double shares[2] = {1 - t, t};
  Color color = mesh.look.surface.color;
  Vec place;
  if (mesh.look.surface.showsVertexColors) color = {};
  for (int i = 0; i < 2; ++i) {
    place = place + mesh.vertices.place(ends[i]) * shares[i];
    if (mesh.look.surface.showsVertexColors)
      add(color, vertexColor(mesh, ends[i]), float(shares[i]));
  }
  return seen(mesh, color, place);
}

} // namespace picture::raster
