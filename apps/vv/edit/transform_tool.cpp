#include "edit/transform_tool.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <Imath/ImathMatrixAlgo.h>
#include <fmt/format.h>

#include "edit/actions.h"
#include "edit/as_printed.h"
#include "xvrml/nodes.h"

namespace vv {

using namespace xvrml;
using Imath::M44d;
using Imath::Quatd;
using Imath::V3d;

namespace {

constexpr double degrees = 180 / std::numbers::pi;
// The cosine between an axis and the direction to the viewer, below which the picture of a turn is
// no circle any more.
constexpr double leastFacing = 0.2;
constexpr const char* verbs[] = {"Move", "Turn", "Scale"};

V3d vectorOf(const double* numbers) { return {numbers[0], numbers[1], numbers[2]}; }
V3d vectorOf(const Vec3f& v) { return {asPrinted(v.x), asPrinted(v.y), asPrinted(v.z)}; }
Vec3f floats(const V3d& v) { return {float(v.x), float(v.y), float(v.z)}; }

// Returns where a ray meets the plane through a point that faces the camera.
V3d inPlane(const CameraRay& ray, const V3d& point, const V3d& normal) {
  const V3d origin = vectorOf(ray.origin), direction = vectorOf(ray.direction);
  const double along = direction.dot(normal);
  return along == 0 ? point : origin + direction * ((point - origin).dot(normal) / along);
}

// Returns the place on a line, in lengths of its direction, that is nearest to a ray.
double alongLine(const CameraRay& ray, const V3d& point, const V3d& line) {
  const V3d origin = vectorOf(ray.origin), direction = vectorOf(ray.direction).normalized();
  const V3d between = point - origin;
  const double cosine = line.dot(direction), sine2 = 1 - cosine * cosine;
  if (sine2 < 1e-6) return 0; // the line points at the viewer
  return (between.dot(direction) * cosine - between.dot(line)) / sine2;
}

// Returns the rotation of a file's SFRotation, whose axis may have any length.
Quatd turnOf(const Rotation& r) {
  const V3d axis(r.x, r.y, r.z);
  if (axis.length() == 0) return {};
  Quatd turn;
  return turn.setAxisAngle(axis.normalized(), r.angle);
}

// Returns what a key types, without the name of the keypad.
std::string signOf(const std::string& key) {
  return key.starts_with("Keypad ") ? key.substr(7) : key;
}

} // namespace

Rotation rotationOf(const Quatd& turn) {
  const double angle = turn.angle();
  if (!(std::abs(angle) > 1e-9)) return {0, 0, 1, 0};
  V3d axis = turn.axis();
  for (int i = 0; i < 3; ++i) // rounding of an axis that is one of the three
    if (std::abs(axis[i]) < 1e-12) axis[i] = 0;
  // Negative angles and those above a half turn are the same turn about the opposite axis.
  const bool opposite = angle > std::numbers::pi;
  const V3d shown = opposite ? -axis : axis;
  return {float(shown.x), float(shown.y), float(shown.z),
          float(opposite ? 2 * std::numbers::pi - angle : angle)};
}

V3d TransformFrame::axis(int axis, bool isOwn) const {
  V3d unit(0);
  unit[axis] = 1;
  if (!isOwn) return unit;
  V3d world;
  toWorld.multDirMatrix(unit * rotation.toMatrix44(), world);
  return world.length() > 0 ? world.normalized() : unit;
}

std::optional<TransformFrame> frameOf(Browser& browser, Node& node) {
  NodePlacement placement;
  if (!browser.locate(node, placement)) return {};
  TransformFrame frame;
  if (const size_t depth = placement.path.size(); depth > 1)
    std::copy(placement.path[depth - 2].toWorld.begin(), placement.path[depth - 2].toWorld.end(),
              &frame.toWorld.x[0][0]);
  V3d centre(0);
  if (const auto* const transform = nodeCast<nodes::Transform>(&node)) {
    frame.translation = vectorOf(transform->translation);
    frame.scale = vectorOf(transform->scale);
    frame.rotation = turnOf(transform->rotation);
    centre = vectorOf(transform->center);
  }
  frame.pivot = (frame.translation + centre) * frame.toWorld;
  return frame;
}

double halfHeightAt(const EditView& view, const V3d& point) {
  if (!(view.camera.fovy > 0)) return view.camera.height / 2;
  const V3d eye = vectorOf(view.camera.matrix + 12), normal = vectorOf(view.camera.matrix + 8);
  return std::abs((point - eye).dot(normal)) * std::tan(view.camera.fovy / 2);
}

TransformTool::TransformTool(WorldEditor& editor, Kind kind, const EditView& view, double x,
                             double y)
    : kind_(kind), view_(view), startX_(x), startY_(y) {
  if (!editor.selected()) throw EditError("nothing is selected");
  selected_ = editor.selection();
  editor.select({NodeRef(editor.selected())});
  editor.editor().begin(fmt::format("{} {}", verbs[size_t(kind)], editor.selected()->type().name));
  try {
    if (!nodeCast<nodes::Transform>(editor.selected())) wrapSelected(editor);
    node_ = NodeRef(editor.selected());
    const std::optional<TransformFrame> frame = frameOf(editor.browser(), *node_);
    if (!frame) throw EditError(fmt::format("{} is not in the scene", labelOf(*node_)));
    frame_ = *frame;
    // Behind the viewer there is no place in the picture: turns and scales are about its middle.
    if (!projectPoint(view.camera, view.aspect, &frame_.pivot.x, pivotX_, pivotY_))
      pivotX_ = pivotY_ = 0;
  } catch (...) {
    cancel(editor);
    throw;
  }
}

void TransformTool::cancel(WorldEditor& editor) {
  editor.editor().cancel();
  editor.select(selected_);
}

void TransformTool::chooseAxis(int axis) {
  if (axis_ != axis) {
    axis_ = axis;
    isLocal_ = false;
  } else if (!isLocal_) {
    isLocal_ = true;
  } else {
    axis_ = -1;
    isLocal_ = false;
  }
}

bool TransformTool::isNumberKey(const std::string& key) {
  const std::string sign = signOf(key);
  return key == "Backspace" || sign == "." || sign == "-" ||
         (sign.size() == 1 && sign[0] >= '0' && sign[0] <= '9');
}

bool TransformTool::type(const std::string& key) {
  if (!isNumberKey(key)) return false;
  constexpr size_t mostDigits = 16;
  const std::string sign = signOf(key);
  if (key == "Backspace") {
    if (!typed_.empty()) typed_.pop_back();
  } else if (sign == "-") {
    typed_ = typed_.starts_with('-') ? typed_.substr(1) : "-" + typed_;
  } else if (typed_.size() < mostDigits && (sign != "." || typed_.find('.') == typed_.npos)) {
    typed_ += sign;
  }
  return true;
}

// Returns the number that is typed, or that of the pointer, perhaps rounded to steps.
double TransformTool::chosen(double byPointer, double step) {
  const bool isNumber = typed_.find_first_of("0123456789") != typed_.npos;
  amount_ = isNumber            ? std::strtod(typed_.c_str(), nullptr)
            : snap_ && step > 0 ? std::round(byPointer / step) * step
                                : byPointer;
  return amount_;
}

void TransformTool::point(WorldEditor& editor, double x, double y) {
  switch (kind_) {
  case Kind::move: return move(editor, x, y);
  case Kind::turn: return turn(editor, x, y);
  case Kind::scale: return scale(editor, x, y);
  }
}

void TransformTool::move(WorldEditor& editor, double x, double y) {
  const CameraRay from = rayThrough(view_.camera, view_.aspect, startX_, startY_),
                  to = rayThrough(view_.camera, view_.aspect, x, y);
  const V3d normal = vectorOf(view_.camera.matrix + 8), &pivot = frame_.pivot;
  // A step of a power of ten that is well to be seen.
  const double size = halfHeightAt(view_, pivot);
  const double step = size > 0 ? std::pow(10, std::floor(std::log10(size / 5))) : 0;
  V3d way;
  if (axis_ >= 0) {
    const V3d axis = axisInWorld();
    way = axis * chosen(alongLine(to, pivot, axis) - alongLine(from, pivot, axis), step);
  } else {
    way = inPlane(to, pivot, normal) - inPlane(from, pivot, normal);
    const double length = way.length();
    if (const double wanted = chosen(length, step); length > 0)
      way *= wanted / length;
    else
      way = vectorOf(view_.camera.matrix) * wanted; // a typed number alone: to the right
  }
  V3d own;
  frame_.toWorld.inverse().multDirMatrix(way, own);
  editor.editor().set(*node_, "translation", floats(frame_.translation + own));
}

// Returns by how many radians the pointer has turned about an axis.
double TransformTool::angleTo(double x, double y, const V3d& axis) const {
  const V3d toEye = vectorOf(view_.camera.matrix + 12) - frame_.pivot;
  const V3d toViewer = axis_ >= 0 && view_.camera.fovy > 0 && toEye.length() > 0
                           ? toEye.normalized()
                           : vectorOf(view_.camera.matrix + 8);
  const double facing = axis.dot(toViewer);
  if (std::abs(facing) < leastFacing) {
    // The axis lies in the picture: the pointer turns the near side as the rim of a wheel.
    const V3d rim = axis.cross(toViewer).normalized();
    const double across = (x - startX_) * view_.aspect, along = y - startY_;
    return (across * rim.dot(vectorOf(view_.camera.matrix)) +
            along * rim.dot(vectorOf(view_.camera.matrix + 4))) /
           handleSize;
  }
  const auto angleAt = [this](double atX, double atY) {
    return std::atan2(atY - pivotY_, (atX - pivotX_) * view_.aspect);
  };
  const double angle =
      std::remainder(angleAt(x, y) - angleAt(startX_, startY_), 2 * std::numbers::pi);
  return facing < 0 ? -angle : angle; // the picture turns as the pointer does
}

void TransformTool::turn(WorldEditor& editor, double x, double y) {
  const V3d axis = axis_ >= 0 ? axisInWorld() : vectorOf(view_.camera.matrix + 8);
  const double angle = angleTo(x, y, axis);
  V3d own;
  frame_.toWorld.inverse().multDirMatrix(axis, own);
  if (own.length() == 0) return;
  if (frame_.toWorld.determinant() < 0) own = -own; // a mirrored parent turns the other way
  Quatd turn;
  turn.setAxisAngle(own.normalized(), chosen(angle * degrees, 5) / degrees);
  // Imath multiplies row vectors: the node's own turn comes first.
  editor.editor().set(*node_, "rotation", rotationOf(turn * frame_.rotation));
}

void TransformTool::scale(WorldEditor& editor, double x, double y) {
  const auto distance = [this](double atX, double atY) {
    return std::hypot((atX - pivotX_) * view_.aspect, atY - pivotY_);
  };
  const double start = distance(startX_, startY_);
  const double factor = chosen(start > 1e-6 ? distance(x, y) / start : 1, 0.1);
  if (!(factor > 0)) return; // a scale is greater than 0
  V3d size = frame_.scale;
  if (axis_ >= 0)
    size[axis_] *= factor;
  else
    size *= factor;
  editor.editor().set(*node_, "scale", floats(size));
}

std::string TransformTool::text() const {
  const std::string axis =
      axis_ < 0 ? ""
                : fmt::format(" {} {}", kind_ == Kind::turn ? "about" : "along",
                              std::string(isLocal_ ? "its own " : "") + "xyz"[axis_]);
  const char* const unit = kind_ == Kind::turn ? " degrees" : "";
  return fmt::format("{}{}: {:.5g}{}   (X Y Z: axis; numbers; Ctrl: steps; Enter; Escape)",
                     verbs[size_t(kind_)], axis, amount_, unit);
}

} // namespace vv
