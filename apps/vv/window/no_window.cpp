// no_window.cpp: Replaces the window in a build without SDL.
#include "window/window.h"

namespace vv {

int runWindow(const Options&, const std::vector<std::string>&) {
  throw Failure{exitRender,
                "no window: vv was built without SDL; -o picture.png makes a picture without one"};
}

std::string windowLibrary() { return ""; }
std::string editorLibrary() { return ""; }

} // namespace vv
