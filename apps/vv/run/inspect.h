// inspect.h: The facts of a loaded world that jobs such as --info print, instead of a picture or
// beside it. [main thread]
#pragma once

#include <string>

#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

// Returns the text that a job prints. A job with both functions uses the second if there is a
// world.
struct Inspection {
  std::string (*ofProgram)(const Options& options) = nullptr; // loads no world
  std::string (*ofWorld)(const Options& options, xvrml::Browser& browser) = nullptr;
};

std::string inspectWorld(const Options& options, xvrml::Browser& browser);      // --info
std::string inspectObjects(const Options& options, xvrml::Browser& browser);    // --explain
std::string inspectNodes(const Options& options, xvrml::Browser& browser);      // --list-nodes
std::string inspectViewpoints(const Options& options, xvrml::Browser& browser); // --list-viewpoints

// Returns settings for a Renderer that maps a world and draws nothing.
picture::RenderSettings withoutPicture(picture::RenderSettings settings);

} // namespace vv
