// texts.h: Writes the messages to a page. Pure functions; docs/serve.md lists the messages. [any
// thread]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/live.h"
#include "server/pages.h"
#include "xvrml/viewer.h"

namespace vv::server {

// Says what a page is told about the world and its own place in it.
struct PageState {
  std::string world; // name of the file
  Page::Role role = Page::Role::follower;
  size_t pages = 1;
  int viewpoint = -1;             // number in the list of viewpoints; -1: none
  bool hand = false;              // the pointer is over a sensor or an Anchor
  std::string bottom;             // a message, or the description of what is under the pointer
  std::vector<std::string> facts; // lines about the picture
  bool keys = false;              // a sensor of the world gets the keys
};

std::string helloText();
// Tells a page that it may edit, what it can add, and what keys and mouse do in the editor.
std::string editorText();
std::string stateText(const PageState& state);
std::string viewpointsText(const std::vector<xvrml::ViewpointName>& viewpoints);
std::string commandText(const std::string& line);
std::string savedText(const std::string& path, const std::string& name);
std::string openText(const std::string& url);
// Returns a binary message: the facts of a picture as JSON, after their length in 4 bytes, and the
// bytes of its JPEG file. number: for the acknowledgement.
std::string pictureMessage(uint32_t number, const picture::LivePicture& facts, int wanted,
                           std::string_view jpeg);

// Returns the name of a file for pages: that of the world's file without its suffix, and an end.
std::string downloadName(const std::string& world, const std::string& end);

// Returns the first URL that leads to a page of the web; empty if there is none.
std::string webUrlOf(std::span<const std::string> urls);

} // namespace vv::server
