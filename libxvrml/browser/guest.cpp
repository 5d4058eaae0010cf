#include "xvrml/guest.h"

#include <cmath>
#include <optional>

#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"
#include "geometry/lens.h"
#include "nodes/viewpoint.h"

namespace xvrml {

struct Guest::Impl {
  Browser& browser;
  NodeRef carrier;                  // the Viewpoint; null: none
  Matrix offset;                    // matrix from the Viewpoint to the guest
  Matrix last;                      // the view, as it was last known
  std::optional<Navigation> chosen; // none: nothing was chosen
  Motion motion;                    // its view is not used between moves
  Vector up{0, 1, 0};

  Interaction& interaction() const { return interactionOf(browser.events()); }
  // Returns the Viewpoint if it is still part of the world.
  Node* viewpoint() const { return carrier && isInScene(*carrier) ? carrier.get() : nullptr; }
  Matrix view() const {
    const Node* node = viewpoint();
    const Matrix now = node ? rigid(compose(Viewer::placeOf(node), offset)) : last;
    return finite(now) ? now : last;
  }
  void keep(const Matrix& view) {
    last = view;
    Matrix inverse;
    if (const Node* node = viewpoint())
      offset = invert(Viewer::placeOf(node), inverse) ? compose(inverse, view) : Matrix();
  }
  // A guest whose Viewpoint leaves the world stays where it was. So the view is noted while the
  // Viewpoint exists.
  void note() {
    last = view();
    if (!viewpoint()) carrier = {};
  }
  void stop() {
    motion.fall = 0;
    motion.hasCenter = false;
  }
};

Guest::Guest(Browser& browser) : impl_(std::make_unique<Impl>(Impl{browser, {}, {}, {}, {}, {}})) {
  Interaction& interaction = impl_->interaction();
  impl_->carrier = NodeRef(interaction.binding.bound().viewpoint);
  impl_->chosen = interaction.navigation.type();
  impl_->up = interaction.navigation.up();
  impl_->keep(interaction.viewer.view());
}

Guest::~Guest() = default;

CameraSettings Guest::camera(double aspect) const {
  impl_->note();
  CameraSettings camera;
  toArray(impl_->last, camera.matrix);
  const auto fields = viewpointFields(impl_->carrier.get());
  setLens(camera, fields, Viewer::surroundingsOf(impl_->carrier.get()), aspect);
  return camera;
}

void Guest::place(const double view[16]) {
  const Matrix to = fromArray(view);
  if (!finite(to)) return;
  impl_->keep(to);
  impl_->stop();
}

void Guest::goTo(Node& viewpoint) {
  if (!isViewpoint(&viewpoint)) return;
  impl_->carrier = NodeRef(&viewpoint);
  impl_->offset = Matrix();
  impl_->note();
  impl_->stop();
}

Node* Guest::viewpoint() const { return impl_->viewpoint(); }

void Guest::setUp(const double up[3]) {
  const Vector v(up[0], up[1], up[2]);
  const double length = v.length();
  if (length > 0 && std::isfinite(length)) impl_->up = v / length;
}

Navigation Guest::navigation() const {
  return impl_->interaction().navigation.typeFor(impl_->chosen);
}

bool Guest::setNavigation(Navigation type) {
  impl_->chosen = type;
  impl_->stop();
  return navigation() == type;
}

void Guest::navigate(const NavigationInput& input, double dt) {
  impl_->note();
  Motion& motion = impl_->motion;
  motion.view = impl_->last;
  Navigator& navigator = impl_->interaction().navigation;
  const Avatar avatar = navigator.avatarAt(impl_->viewpoint(), impl_->up);
  motion = navigator.moved(motion, navigation(), avatar, input, dt, Navigator::Touches::ignored);
  if (motion.view != impl_->last) impl_->keep(motion.view);
}

} // namespace xvrml
