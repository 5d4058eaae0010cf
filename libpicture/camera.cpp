#include "libpicture/camera.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include "libpicture/vec.h"

namespace picture {

namespace {

// Returns the coordinate axis that makes the largest angle with the direction v.
Vec acrossAxis(Vec v) {
  const double x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  if (x <= y && x <= z) return {1, 0, 0};
  return y <= z ? Vec{0, 1, 0} : Vec{0, 0, 1};
}

} // namespace

bool lookAtMatrix(const LookAt& view, double matrix[16]) {
  const double* p = view.position;
  Vec back{p[0] - view.target[0], p[1] - view.target[1], p[2] - view.target[2]};
  const double distance = length(back);
  if (!(distance > 0) || !std::isfinite(distance)) return false;
  back = back / distance;
  Vec up{view.up[0], view.up[1], view.up[2]};
  up = length(up) > 0 ? up / length(up) : Vec{0, 1, 0};
  Vec right = cross(up, back);
  if (length(right) < 1e-9) right = cross(acrossAxis(back), back);
  right = right / length(right);
  up = cross(back, right);
  const double columns[16] = {right.x, right.y, right.z, 0, up.x, up.y, up.z, 0,
                              back.x,  back.y,  back.z,  0, p[0], p[1], p[2], 1};
  std::copy_n(columns, 16, matrix);
  return true;
}

LookAt lookAtOf(const double rows[16]) {
  constexpr double rounding = 1e-4; // measured poses are rounded
  double off = 0;
  for (size_t i = 0; i < 4; ++i) off = std::max(off, std::abs(rows[12 + i] - (i == 3 ? 1 : 0)));
  for (size_t a = 0; a < 3; ++a)
    for (size_t b = 0; b < 3; ++b) {
      double product = 0;
      for (size_t i = 0; i < 3; ++i) product += rows[4 * i + a] * rows[4 * i + b];
      off = std::max(off, std::abs(product - (a == b ? 1 : 0)));
    }
  double handed = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double *r = rows + 4 * i, *s = rows + 4 * ((i + 1) % 3), *t = rows + 4 * ((i + 2) % 3);
    handed += r[0] * (s[1] * t[2] - t[1] * s[2]);
  }
  if (!(off <= rounding) || !(handed > 0))
    throw std::invalid_argument(
        "the 4x4 matrix must turn and move only, within 1e-4, with 0 0 0 1 as its last row");
  LookAt camera;
  camera.saysUp = true;
  for (size_t i = 0; i < 3; ++i) {
    if (!std::isfinite(rows[4 * i + 3]))
      throw std::invalid_argument("the 4x4 matrix has a number that is not finite");
    camera.position[i] = rows[4 * i + 3];
    camera.target[i] = rows[4 * i + 3] - rows[4 * i + 2];
    camera.up[i] = rows[4 * i + 1];
  }
  return camera;
}

// The rays of a symmetric camera with square pixels and the focal length fy are sheared to those of
// the intrinsics.
View::Pinhole pinholeOf(const Intrinsics& inner, const double matrix[16], int width, int height) {
  View::Pinhole camera{};
  camera.fovy = 2 * std::atan(height / 2.0 / inner.fy);
  const double up = (inner.cy - height / 2.0) / inner.fy,
               right = (width / 2.0 - inner.cx) / inner.fx + inner.skew / inner.fx * up;
  for (size_t i = 0; i < 3; ++i) {
    const double x = matrix[i], y = matrix[4 + i], z = matrix[8 + i], place = matrix[12 + i];
    const double columns[] = {x, y, z, place};
    const double sheared[] = {x * inner.fy / inner.fx, y + x * inner.skew / inner.fx,
                              z - x * right - y * up, place};
    for (size_t k = 0; k < 4; ++k) {
      camera.matrix[4 * k + i] = columns[k];
      camera.sheared[4 * k + i] = sheared[k];
    }
  }
  camera.matrix[15] = camera.sheared[15] = 1;
  return camera;
}

double verticalAngle(double smaller, double aspect) {
  return aspect >= 1 ? smaller : 2 * std::atan(std::tan(smaller / 2) / aspect);
}

namespace {

// Rotates a camera about an axis through the centre of the bounds.
void turn(xvrml::CameraSettings& camera, const xvrml::Bounds& bounds, xvrml::Axis axis,
          double angle) {
  const int along = int(axis) % 3, first = (along + 1) % 3, second = (along + 2) % 3;
  const auto middle = [&](int i) {
    return bounds.empty ? 0 : (bounds.minimum[i] + bounds.maximum[i]) / 2;
  };
  const double a = middle(first), b = middle(second);
  const double c = std::cos(angle), s = int(axis) < 3 ? std::sin(angle) : -std::sin(angle);
  for (size_t column = 0; column < 4; ++column) {
    double* v = camera.matrix + 4 * column;
    const double x = v[first] - (column == 3 ? a : 0), y = v[second] - (column == 3 ? b : 0);
    v[first] = c * x - s * y + (column == 3 ? a : 0);
    v[second] = s * x + c * y + (column == 3 ? b : 0);
  }
}

// A direction from the model to the eye: degrees to the right of the front, and above.
struct SideInfo {
  const char* name;
  double right, above;
};
constexpr SideInfo sides[] = {
    {"three-quarter", 35, 25}, {"above", 20, 50}, {"front", 0, 0}, {"back", 180, 0},
    {"left", -90, 0},          {"right", 90, 0},  {"top", 0, 90},  {"bottom", 0, -90}};

// Writes the axes of a camera that looks at a model from a side.
void sideView(Side side, xvrml::Axis axis, double view[16]) {
  constexpr double radians = std::numbers::pi / 180;
  const SideInfo& info = sides[size_t(side)];
  double quarter[16], upward[3];
  xvrml::threeQuarterView(axis, quarter);
  xvrml::upVector(axis, upward);
  // the front is 35 degrees to the left of the three-quarter view
  const Vec up{upward[0], upward[1], upward[2]}, across{quarter[0], quarter[1], quarter[2]};
  const Vec forward = cross(across, up); // horizontal, from the model to the eye
  const auto turned = [&](double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return Vec{c * forward.x + s * across.x, c * forward.y + s * across.y,
               c * forward.z + s * across.z};
  };
  const double angle = (info.right - 35) * radians, above = info.above * radians;
  const Vec level = turned(angle), right = turned(angle + std::numbers::pi / 2);
  const double c = std::cos(above), s = std::sin(above);
  const Vec back{c * level.x + s * up.x, c * level.y + s * up.y, c * level.z + s * up.z};
  // at the bottom the picture's right side stays where it is for an eye that looks from the top
  const double mirror = side == Side::bottom ? -1 : 1;
  const Vec x{mirror * right.x, mirror * right.y, mirror * right.z}, y = cross(back, x);
  const double columns[16] = {x.x,    x.y,    x.z,    0, y.x, y.y, y.z, 0,
                              back.x, back.y, back.z, 0, 0,   0,   0,   1};
  std::copy_n(columns, 16, view);
}

// Shows the whole world along the axes of a view: all that a turn brings, or just what is seen.
xvrml::CameraSettings around(const xvrml::OpenRTMapper& mapper, const View& view,
                             const double axes[16], double fovy, double aspect) {
  return view.turns ? xvrml::cameraAround(mapper.boundingSphere(), axes, fovy, aspect)
                    : mapper.cameraAround(axes, fovy, aspect);
}

// Turns a view to one from behind, or to one from below, whose picture has its up side up as well.
void turnBehind(const double up[3], double view[16]) {
  for (int column = 0; column < 3; ++column) {
    double* const v = view + 4 * column;
    const double along = v[0] * up[0] + v[1] * up[1] + v[2] * up[2];
    for (int i = 0; i < 3; ++i) v[i] = 2 * along * up[i] - v[i];
  }
}
void turnBelow(const double up[3], double view[16]) {
  double* const z = view + 8;
  const double above = z[0] * up[0] + z[1] * up[1] + z[2] * up[2];
  for (int i = 0; i < 3; ++i) z[i] -= 2 * above * up[i];
  const Vec y = cross({z[0], z[1], z[2]}, {view[0], view[1], view[2]});
  view[4] = y.x;
  view[5] = y.y;
  view[6] = y.z;
}

// Looks at a model from behind or from below where it turns nothing but backs to the view, which
// are not drawn.
void avoidBacks(const xvrml::OpenRTMapper& mapper, xvrml::Axis axis, double view[16]) {
  if (!mapper.facesAway(view)) return;
  double up[3], other[16];
  xvrml::upVector(axis, up);
  for (const auto turned : {turnBehind, turnBelow}) {
    std::copy_n(view, 16, other);
    turned(up, other);
    if (mapper.facesAway(other)) continue;
    std::copy_n(other, 16, view);
    return;
  }
}

// Shows a model from three quarters, or a figure in the x-y plane from the front.
xvrml::CameraSettings modelCamera(const xvrml::OpenRTMapper& mapper, const View& view, double fovy,
                                  double aspect) {
  double axes[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  xvrml::Axis up = view.up.value_or(xvrml::Axis::y);
  if (view.up) {
    xvrml::threeQuarterView(up, axes);
  } else if (const xvrml::UpGuess guess = mapper.guessUp(); !guess.frontal) {
    up = guess.axis;
    xvrml::threeQuarterView(up, axes);
  }
  avoidBacks(mapper, up, axes);
  return around(mapper, view, axes, fovy, aspect);
}

} // namespace

bool lookAtMatrix(const View& view, double matrix[16]) {
  if (!view.lookAt) return false;
  LookAt look = *view.lookAt;
  if (view.up && !look.saysUp) xvrml::upVector(*view.up, look.up);
  return lookAtMatrix(look, matrix);
}

std::optional<Side> sideNamed(std::string_view name) {
  for (size_t i = 0; i < std::size(sides); ++i)
    if (name == sides[i].name) return Side(i);
  return {};
}

const char* sideName(Side side) { return sides[size_t(side)].name; }

std::string sideNames() {
  std::string all;
  for (const SideInfo& info : sides) all += (all.empty() ? "" : ", ") + std::string(info.name);
  return all;
}

static constexpr const char* axisNames[] = {"x", "y", "z", "-x", "-y", "-z"};

std::optional<xvrml::Axis> axisNamed(std::string_view name) {
  if (name.size() == 2 && name.starts_with('+')) name.remove_prefix(1);
  for (size_t i = 0; i < std::size(axisNames); ++i)
    if (name == axisNames[i]) return xvrml::Axis(i);
  return {};
}

const char* axisName(xvrml::Axis axis) { return axisNames[size_t(axis)]; }

xvrml::Axis upOf(const xvrml::OpenRTMapper& mapper, const View& view) {
  if (view.up) return *view.up;
  return mapper.boundViewpoint() >= 0 ? xvrml::Axis::y : mapper.guessUp().axis;
}

bool leavesViewpointOut(const xvrml::OpenRTMapper& mapper, const View& view, double aspect) {
  if (view.authored != View::Authored::unlessCut) return view.authored == View::Authored::leftOut;
  if (mapper.boundViewpoint() < 0) return false;
  const xvrml::CameraSettings camera = mapper.viewpointCamera(size_t(mapper.boundViewpoint()));
  const xvrml::Bounds bounds = mapper.bounds();
  bool inside = !bounds.empty;
  for (int i = 0; i < 3; ++i)
    inside = inside && camera.matrix[12 + i] > bounds.minimum[i] &&
             camera.matrix[12 + i] < bounds.maximum[i];
  return !inside && !mapper.seesAll(camera, aspect);
}

xvrml::CameraSettings chooseCamera(const xvrml::OpenRTMapper& mapper, const View& view,
                                   double aspect) {
  constexpr double radians = std::numbers::pi / 180;
  // the default of Viewpoint.fieldOfView
  const double smaller = view.fov ? *view.fov * radians : std::numbers::pi / 4;
  const double fovy = view.ortho ? 0 : verticalAngle(smaller, aspect);
  xvrml::CameraSettings camera;
  if (view.pinhole) {
    std::copy_n(view.pinhole->matrix, 16, camera.matrix);
    camera.fovy = view.pinhole->fovy;
    return camera;
  }
  if (view.side) {
    double axes[16];
    sideView(*view.side, upOf(mapper, view), axes);
    camera = around(mapper, view, axes, fovy, aspect);
  } else if (view.lookAt) {
    lookAtMatrix(view, camera.matrix);
    camera.fovy = fovy;
    if (view.fit) camera = around(mapper, view, camera.matrix, fovy, aspect);
  } else if (leavesViewpointOut(mapper, view, aspect)) {
    const auto first = mapper.viewpointCamera(size_t(std::max(0, mapper.boundViewpoint())));
    camera = modelCamera(mapper, view, view.fov ? fovy : first.fovy, aspect);
  } else if (view.viewer && !view.viewpoint && !view.fit) {
    camera = *view.viewer;
    if (view.fov) camera.fovy = fovy;
  } else if (view.viewpoint || (!view.fit && mapper.boundViewpoint() >= 0)) {
    camera = mapper.viewpointCamera(
        view.viewpoint.value_or(size_t(std::max(0, mapper.boundViewpoint()))));
    if (view.fov) camera.fovy = fovy;
  } else if (mapper.boundViewpoint() >= 0 && !view.up) {
    camera = mapper.fitCamera(fovy);
  } else {
    camera = modelCamera(mapper, view, fovy, aspect);
  }
  if (view.ortho) {
    camera.fovy = 0;
    camera.height = *view.ortho;
  }
  if (view.turn != 0) turn(camera, mapper.bounds(), upOf(mapper, view), view.turn);
  if (view.shader) camera.shader = view.shader.get();
  return camera;
}

} // namespace picture
