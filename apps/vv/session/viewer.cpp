#include "session/viewer.h"

#include <algorithm>

#include "xvrml/guest.h"

namespace vv {

namespace {

class WorldViewer final : public Viewer {
 public:
  explicit WorldViewer(xvrml::Browser& browser) : browser_(browser) {}

  bool isOfWorld() const override { return true; }
  xvrml::CameraSettings camera(double aspect) const override { return browser_.camera(aspect); }
  void setAspect(double aspect) override { browser_.setAspect(aspect); }
  void setUp(const double up[3]) override { browser_.setUp(up); }
  void setTransition(double seconds) override { browser_.setTransition(seconds); }
  void place(const double view[16]) override { browser_.placeViewer(view); }
  void move(const xvrml::NavigationInput& input, double seconds) override {
    browser_.navigate(input, seconds);
  }
  xvrml::Navigation navigation() const override { return browser_.navigation(); }
  bool setNavigation(xvrml::Navigation type) override { return browser_.setNavigation(type); }
  const xvrml::Node* viewpoint() const override { return browser_.bound().viewpoint; }
  void goTo(xvrml::Node& viewpoint) override {
    if (browser_.bound().viewpoint == &viewpoint) goBack();
    browser_.set(viewpoint, "set_bind", true);
  }
  void goBack() override { browser_.key(xvrml::Key::home, true); }
  void step(Step step) override {
    browser_.key(step == Step::next ? xvrml::Key::pageDown : xvrml::Key::pageUp, true);
  }

 private:
  xvrml::Browser& browser_;
};

// A guest jumps at once, because the world, whose time a transition would need, may be paused.
class GuestViewer final : public Viewer {
 public:
  explicit GuestViewer(xvrml::Browser& browser) : browser_(browser), guest_(browser) {}

  bool isOfWorld() const override { return false; }
  xvrml::CameraSettings camera(double aspect) const override { return guest_.camera(aspect); }
  void setAspect(double) override {}
  void setUp(const double up[3]) override { guest_.setUp(up); }
  void setTransition(double) override {}
  void place(const double view[16]) override { guest_.place(view); }
  void move(const xvrml::NavigationInput& input, double seconds) override {
    guest_.navigate(input, seconds);
  }
  xvrml::Navigation navigation() const override { return guest_.navigation(); }
  bool setNavigation(xvrml::Navigation type) override { return guest_.setNavigation(type); }
  const xvrml::Node* viewpoint() const override { return guest_.viewpoint(); }
  void goTo(xvrml::Node& viewpoint) override { guest_.goTo(viewpoint); }
  void goBack() override {
    if (xvrml::Node* viewpoint = guest_.viewpoint()) guest_.goTo(*viewpoint);
  }
  void step(Step step) override {
    const std::vector<xvrml::ViewpointName> list = visitedViewpoints(browser_);
    if (list.empty()) return;
    const auto at = std::find_if(list.begin(), list.end(), [&](const xvrml::ViewpointName& one) {
      return one.node.get() == guest_.viewpoint();
    });
    const size_t count = list.size(), i = size_t(at - list.begin());
    const bool known = at != list.end();
    if (step == Step::next)
      guest_.goTo(*list[known ? (i + 1) % count : 0].node);
    else
      guest_.goTo(*list[known ? (i + count - 1) % count : count - 1].node);
  }

 private:
  xvrml::Browser& browser_;
  xvrml::Guest guest_;
};

} // namespace

std::unique_ptr<Viewer> makeWorldViewer(xvrml::Browser& browser) {
  return std::make_unique<WorldViewer>(browser);
}

std::unique_ptr<Viewer> makeGuestViewer(xvrml::Browser& browser) {
  return std::make_unique<GuestViewer>(browser);
}

std::vector<xvrml::ViewpointName> visitedViewpoints(const xvrml::Browser& browser) {
  std::vector<xvrml::ViewpointName> all = browser.viewpoints(), some;
  for (const xvrml::ViewpointName& one : all)
    if (!one.description.empty()) some.push_back(one);
  return some.empty() ? all : some;
}

} // namespace vv
