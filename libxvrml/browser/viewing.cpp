// viewing.cpp: the Browser's members about the viewer: binding, camera, pointer, navigation. See xvrml/browser.h.
#include "behaviour/interaction.h"
#include "browser/state.h"

namespace xvrml {

BoundNodes Browser::bound() const { return interactionOf(*impl_->engine).binding.bound(); }

CameraSettings Browser::camera(double aspect) const { return interactionOf(*impl_->engine).viewer.camera(aspect); }

void Browser::setTransition(double seconds) { interactionOf(*impl_->engine).viewer.setTransition(seconds); }

} // namespace xvrml
