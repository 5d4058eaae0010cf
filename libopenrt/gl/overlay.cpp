// overlay.cpp: Fills triangles, lines and points over the picture (OpenGL 1.1, sections 3.3 to
// 3.5).
#include "gl/overlay.h"

#include <algorithm>
#include <cmath>

#include "gl/mesh.h"

namespace rtgl {
namespace {

constexpr double farthestDepth = 1 + 1e-9;

double lerp(double a, double b, double share) { return a + share * (b - a); }

// Returns a component of a texel, 0 to 1.
double texel(const Texture& texture, int64_t x, int64_t y, int component) {
  const Picture& p = texture.picture;
  const auto place = [](GLenum wrap, int64_t i, int64_t size) {
    return wrap == GL_REPEAT ? (i % size + size) % size : std::clamp(i, int64_t(0), size - 1);
  };
  const int64_t column = place(texture.wrapS, x, p.width), row = place(texture.wrapT, y, p.height);
  return p.texels[static_cast<size_t>((row * p.width + column) * p.components + component)] / 255.0;
}

// Returns a component of the texture at s, t.
double sample(const Texture& texture, double s, double t, int component) {
  const double x = s * texture.picture.width, y = t * texture.picture.height;
  if (!(std::abs(x) < 1e9 && std::abs(y) < 1e9)) return 0;
  const auto at = [&](double column, double row) {
    return texel(texture, static_cast<int64_t>(std::floor(column)),
                 static_cast<int64_t>(std::floor(row)), component);
  };
  if (texture.magFilter == GL_NEAREST) return at(x, y);
  const double left = x - 0.5, low = y - 0.5;
  const double right = left - std::floor(left), up = low - std::floor(low);
  return lerp(lerp(at(left, low), at(left + 1, low), right),
              lerp(at(left, low + 1), at(left + 1, low + 1), right), up);
}

} // namespace

struct Overlay::Point {
  double x, y, z, s, t;
  std::array<double, 4> color;
};

Overlay::Overlay(int width, int height)
    : width_(width), height_(height),
      pixels_(static_cast<size_t>(width) * static_cast<size_t>(height), Color{0, 0, 0, 0}) {}

Overlay::Point Overlay::pointOf(const Vertex& vertex, const Style& style) const {
  const Vector at =
      project(style.toWindow, {vertex.position[0], vertex.position[1], vertex.position[2]});
  const Material& m = style.material;
  const float* move = m.textureTransform;
  const double s = vertex.texCoord[0], t = vertex.texCoord[1];
  Point point = {
      at[0], at[1], at[2], move[0] * s + move[2] * t + move[4], move[1] * s + move[3] * t + move[5],
      {}};
  const Material::Side& side = m.sides[0];
  for (size_t c = 0; c < 3; c++)
    point.color[c] = m.colored ? vertex.color[c] : m.lit ? side.diffuse[c] : side.emission[c];
  point.color[3] = m.vertexAlpha ? vertex.color[3] : side.alpha;
  return point;
}

void Overlay::draw(const Part& part, const Style& style) {
  Part whole = part; // culled by the corners' order in the picture
  whole.cull = whole.lit = false;
  const Mesh mesh = meshOf(whole);
  std::vector<Point> points;
  for (const Vertex& vertex : mesh.vertices) points.push_back(pointOf(vertex, style));
  for (size_t i = 0; i + 2 < mesh.triangles.size(); i += 3)
    triangle(points[mesh.triangles[i]], points[mesh.triangles[i + 1]],
             points[mesh.triangles[i + 2]], style);
  Style line = style;
  line.polygon.cull = false;
  const double half = std::max(std::round(static_cast<double>(part.lineWidth)), 1.0) / 2;
  for (size_t i = 0; i + 1 < mesh.lines.size(); i += 2) {
    const Point &a = points[mesh.lines[i]], &b = points[mesh.lines[i + 1]];
    const bool flat = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
    strip(a, b, flat ? 0 : half, flat ? half : 0, line);
  }
  const double radius = std::max(static_cast<double>(part.pointSize), 1.0) / 2;
  for (const uint32_t i : mesh.points) {
    Point left = points[i], right = points[i];
    left.x -= radius;
    right.x += radius;
    strip(left, right, 0, radius, line);
  }
}

void Overlay::strip(const Point& a, const Point& b, double sideX, double sideY,
                    const Style& style) {
  const auto moved = [&](Point point, double side) {
    point.x += side * sideX;
    point.y += side * sideY;
    return point;
  };
  triangle(moved(a, -1), moved(b, -1), moved(b, 1), style);
  triangle(moved(a, -1), moved(b, 1), moved(a, 1), style);
}

void Overlay::triangle(const Point& first, const Point& second, const Point& third,
                       const Style& style) {
  // Returns twice the area of a triangle, positive if it is counter-clockwise.
  const auto area = [](const Point& a, const Point& b, double x, double y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
  };
  const double whole = area(first, second, third.x, third.y);
  if (whole == 0 || !std::isfinite(whole) || style.polygon.culls(whole)) return;
  const Point &a = first, &b = whole > 0 ? second : third, &c = whole > 0 ? third : second;
  // A pixel whose middle lies on a common edge of two triangles belongs to one of them.
  const auto inside = [](const Point& from, const Point& to, double side) {
    return side > 0 || (side == 0 && (to.y < from.y || (to.y == from.y && to.x < from.x)));
  };
  const auto [x, y, width, height] = style.viewport;
  const auto limit = [](double value, double low, double high) {
    return static_cast<int>(std::clamp(std::floor(value), low, std::max(low, high)));
  };
  const double left = std::max(x, 0.0), right = std::min(x + width, double(width_));
  const double low = std::max(y, 0.0), high = std::min(y + height, double(height_));
  const int firstRow = limit(std::min({a.y, b.y, c.y}), low, high);
  const int endRow = limit(std::max({a.y, b.y, c.y}) + 1, low, high);
  const int firstColumn = limit(std::min({a.x, b.x, c.x}), left, right);
  const int endColumn = limit(std::max({a.x, b.x, c.x}) + 1, left, right);
  for (int row = firstRow; row < endRow; row++)
    for (int column = firstColumn; column < endColumn; column++) {
      const double ofA = area(b, c, column + 0.5, row + 0.5),
                   ofB = area(c, a, column + 0.5, row + 0.5),
                   ofC = area(a, b, column + 0.5, row + 0.5);
      if (!inside(b, c, ofA) || !inside(c, a, ofB) || !inside(a, b, ofC)) continue;
      const auto mix = [&](double atA, double atB, double atC) {
        return (ofA * atA + ofB * atB + ofC * atC) / std::abs(whole);
      };
      Point at = {column + 0.5,       row + 0.5,          mix(a.z, b.z, c.z),
                  mix(a.s, b.s, c.s), mix(a.t, b.t, c.t), {}};
      for (size_t k = 0; k < 4; k++) at.color[k] = mix(a.color[k], b.color[k], c.color[k]);
      if (std::abs(at.z) <= farthestDepth) blend(column, row, at, style);
    }
}

// Draws a pixel over what is there. Rows count from below.
void Overlay::blend(int x, int y, const Point& at, const Style& style) {
  const Material& m = style.material;
  std::array<double, 4> color = at.color;
  if (style.texture) {
    const int components = style.texture->picture.components;
    const bool grey = components <= 2, hasAlpha = components % 2 == 0;
    for (int c = 0; c < (hasAlpha ? 4 : 3); c++) {
      const int component = c == 3 ? components - 1 : grey ? 0 : c;
      const double value = sample(*style.texture, at.s, at.t, component);
      double& out = color[static_cast<size_t>(c)];
      out = m.replace ? value : out * value;
    }
  }
  const double alpha = std::clamp(color[3], 0.0, 1.0);
  if (m.alphaTest && alpha < std::max(static_cast<double>(m.alphaReference), 1.0 / 512)) return;
  const double share = m.blend ? alpha : 1;
  const size_t row = static_cast<size_t>(height_ - 1 - y);
  Color& pixel = pixels_[row * static_cast<size_t>(width_) + static_cast<size_t>(x)];
  for (size_t c = 0; c < 4; c++) {
    const double over = c == 3 ? 1 : std::clamp(color[c], 0.0, 1.0);
    pixel[c] = static_cast<float>(lerp(pixel[c], over, share));
  }
}

} // namespace rtgl
