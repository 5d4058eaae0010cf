#include "behaviour/viewer/viewer.h"

#include <algorithm>
#include <cmath>

#include <Imath/ImathMatrixAlgo.h>
#include <Imath/ImathQuat.h>

#include "behaviour/named_fields.h"
#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"
#include "geometry/lens.h"
#include "nodes/viewpoint.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

using Quaternion = Imath::Quatd;

Vector place(const Matrix& m) { return {m.x[3][0], m.x[3][1], m.x[3][2]}; }

// Interpolates between two views: the eye on a straight line, the rotation about one axis at
// constant speed; s in [0,1].
Matrix between(const Matrix& a, const Matrix& b, double s) {
  const Quaternion p = Imath::extractQuat(a), q = Imath::extractQuat(b);
  Matrix m = Imath::slerpShortestArc(p, q, s).toMatrix44();
  if (!finite(m)) m = rotationOnly(b);
  const Vector eye = place(a) * (1 - s) + place(b) * s;
  m.x[3][0] = eye.x;
  m.x[3][1] = eye.y;
  m.x[3][2] = eye.z;
  return m;
}

// Returns whether a viewpoint keeps how far the viewer has moved from it while it is not bound
// (ISO/IEC 19775-1 23.3.1).
bool retains(const Node* viewpoint) {
  const auto fields = viewpointFields(viewpoint);
  return fields && fields->retainUserOffsets && *fields->retainUserOffsets;
}

Matrix above(const Node* node) {
  if (!node) return {};
  const std::vector<Path> paths = pathsTo(*node, 1);
  const Matrix m = paths.empty() ? Matrix() : localToWorld(paths[0]);
  return finite(m) ? m : Matrix();
}

} // namespace

Node* Viewer::bound() const { return binding_.bound().viewpoint; }

Matrix Viewer::surroundingsOf(const Node* viewpoint) { return above(viewpoint); }

// Returns the Viewpoint's coordinate system. If it is singular, the rigid part is used, because the
// offset needs the inverse.
Matrix Viewer::placeOf(const Node* viewpoint) {
  const auto fields = viewpointFields(viewpoint);
  if (!fields) return translation({0, 0, 10}); // the default Viewpoint of 6.53
  const Matrix m = compose(above(viewpoint), compose(translation(vector(fields->position)),
                                                     rotation(fields->orientation)));
  Matrix inverse;
  return invert(m, inverse) ? m : rigid(m);
}

Matrix Viewer::leavingPlace(const Node* viewpoint) const {
  return viewpoint && !isInScene(*viewpoint) ? lastPlace_ : placeOf(viewpoint);
}

void Viewer::settled() {
  if (const Node* viewpoint = bound()) lastPlace_ = placeOf(viewpoint);
}

Matrix Viewer::target() const { return rigid(compose(placeOf(bound()), offset_)); }

Matrix Viewer::view() const { return shown(target()); }

CameraSettings Viewer::camera(double aspect) const {
  CameraSettings camera;
  toArray(view(), camera.matrix);
  const auto fields = viewpointFields(bound());
  setLens(camera, fields, surroundings(), aspect);
  if (shownRadius_ > 0 && fields && fields->extent) {
    toArray(view(), camera.matrix); // an extent beside the middle does not count
    showSphere(camera, shownRadius_, aspect);
  }
  return camera;
}

// Sets the offset so that the view stays the same. With scale above the Viewpoint the offset
// contains scale too.
void Viewer::keep(const Matrix& view, const Node* viewpoint) {
  Matrix inverse;
  offset_ = invert(placeOf(viewpoint), inverse) ? compose(inverse, view) : Matrix();
  hasLast_ = false;
}

bool Viewer::seeAll(const Node* viewpoint) {
  shownRadius_ = 0;
  const auto fields = viewpointFields(viewpoint);
  Interaction& interaction = interactionOf(engine_);
  if (!fields || !fields->viewAll || !*fields->viewAll || !interaction.scope) return false;
  const PickBox box = interaction.picker.bounds(interaction.scope->roots);
  const auto all = box.empty() ? std::nullopt : viewOfAll(*fields, box.low, box.high);
  if (!all) return false;
  shownRadius_ = all->radius;
  Matrix view = rigid(placeOf(viewpoint));
  const Vector eye = all->middle + Vector(view.x[2][0], view.x[2][1], view.x[2][2]) * all->distance;
  view.x[3][0] = eye.x;
  view.x[3][1] = eye.y;
  view.x[3][2] = eye.z;
  keep(view, viewpoint);
  return true;
}

void Viewer::showAll() {
  const Matrix from = view();
  if (seeAll(bound())) jump(from);
}

void Viewer::moveTo(const Matrix& view) {
  if (!finite(view)) return;
  const bool tracked = hasLast_;
  keep(view, bound());
  hasLast_ = tracked;
  moving_.running = false;
}

void Viewer::reset() {
  const Matrix from = view();
  offset_ = Matrix();
  jump(from);
}

void Viewer::jump(const Matrix& from) {
  jumped_ = true;
  hasLast_ = false;
  const double seconds = transitionSeconds();
  moving_ = {seconds > 0, engine_.now(), seconds, from};
  if (!moving_.running && begun_) completeTransition();
}

// X3D's NavigationInfo says how long a transition takes (ISO/IEC 19775-1 23.4.4). One of VRML97
// says nothing about it.
double Viewer::transitionSeconds() const {
  const auto* info = nodeCast<nodes::NavigationInfo>(binding_.bound().navigationInfo);
  if (!info || !versionOf(*info).isX3d() || !(transition_ > 0)) return transition_;
  for (const std::string& type : info->transitionType) {
    if (type == "TELEPORT") return 0;
    if (type == "LINEAR" || type == "ANIMATE") break;
  }
  return std::isfinite(info->transitionTime) ? std::max(info->transitionTime, 0.0) : transition_;
}

void Viewer::completeTransition() {
  moving_.running = false;
  if (auto* info = nodeCast<nodes::NavigationInfo>(binding_.bound().navigationInfo))
    sendFrom<"transitionComplete">(engine_, *info, true);
}

// Rule b of 6.53. `to` is already on the stack; the view is still relative to `from`.
void Viewer::bind(Node* from, Node* to) {
  shownRadius_ = 0;
  const Matrix seen = shown(rigid(compose(leavingPlace(from), offset_)));
  saved_[from] = offset_;
  const auto before = saved_.find(to);
  const Matrix offset = before != saved_.end() && retains(to) ? before->second : Matrix();
  saved_.erase(to);
  if (!begun_) { // nothing was visible yet: jump FALSE has no view to keep
    offset_ = Matrix();
    seeAll(to);
  } else if (const auto next = viewpointFields(to); next && !next->jump) {
    keep(seen, to);
    moving_.running = false;
  } else {
    offset_ = offset;
    if (offset == Matrix()) seeAll(to);
    jump(seen);
  }
}

// Rule c: returns to the saved position relative to the next Viewpoint. If the leaving Viewpoint
// has jump FALSE, the view stays.
void Viewer::unbind(Node& from, Node* to) {
  shownRadius_ = 0;
  const Matrix seen = shown(rigid(compose(leavingPlace(&from), offset_)));
  const Matrix moved = offset_;
  const auto saved = saved_.find(to);
  if (const auto left = viewpointFields(&from); !left || left->jump) {
    offset_ = saved == saved_.end() ? Matrix() : saved->second;
    jump(seen);
  } else {
    keep(seen, to);
    moving_.running = false;
  }
  saved_.erase(to);
  saved_[&from] = moved;
  left(from);
}

void Viewer::left(const Node& viewpoint) {
  if (!retains(&viewpoint)) saved_.erase(&viewpoint);
}

void Viewer::restart() {
  offset_ = Matrix();
  saved_.clear();
  moving_.running = begun_ = hasLast_ = false;
}

void Viewer::forget(const Node& viewpoint) { saved_.erase(&viewpoint); }

Matrix Viewer::shown(const Matrix& to) const {
  if (!moving_.running) return to;
  const double s = std::clamp((engine_.now() - moving_.start) / moving_.seconds, 0.0, 1.0);
  return between(moving_.from, to, s * s * (3 - 2 * s));
}

void Viewer::setTransition(double seconds) {
  transition_ = std::isfinite(seconds) ? std::max(seconds, 0.0) : 0;
  moving_.running = false;
}

void Viewer::ticked() {
  if (moving_.running && engine_.now() >= moving_.start + moving_.seconds) completeTransition();
  const double step = engine_.now() - lastTick_;
  const Vector now = place(offset_);
  if (!(step > 0) && hasLast_) return;
  speed_ = hasLast_ ? (now - lastOffset_).length() / step : 0;
  lastOffset_ = now;
  lastTick_ = engine_.now();
  hasLast_ = true;
}

} // namespace xvrml
