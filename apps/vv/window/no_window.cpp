// no_window.cpp: what stands for the window where vv is built without SDL.
#include "window/window.h"

namespace vv {

int runWindow(const Options&, const std::vector<std::string>&) {
  throw Failure{exitRender,
                "no window: vv was built without SDL; -o picture.png makes a picture without one"};
}

} // namespace vv
