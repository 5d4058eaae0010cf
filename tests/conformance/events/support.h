// support.h: a small world in a string, run by a Browser. Outgoing events are logged.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "xvrml/browser.h"

namespace xvrml {

// Returns the text of a single value in the form tests expect: "TRUE", "3", "0.5", "1 2 3", "[1
// 2]".
std::string textOf(const Value& value);

class Running {
 public:
  // The clock has epoch 0, so that tests can use times 0, 1, 2. A text without a header of X3D is
  // VRML97.
  explicit Running(const std::string& vrml, double start = 0, BrowserOptions options = {},
                   const RunOptions& run = {.epoch = 0})
      : browser(loadWorldFromMemory((vrml.starts_with("#X3D") ? "" : "#VRML V2.0 utf8\n") + vrml,
                                    "test.wrl"),
                std::move(options), start, run) {}

  Node& node(std::string_view name) { return *browser.node(name); }
  // Appends every later event of name.out to the log as "time name.out value".
  void log(std::string_view name, std::string_view out) {
    const std::string prefix = std::string(name) + "." + std::string(out);
    ASSERT_NE(browser.listen(node(name), out,
                             [this, prefix](Node&, const FieldInfo&, const Value& value) {
                               events.push_back(
                                   fmt::format("{:g} {} {}", browser.now(), prefix, textOf(value)));
                             }),
              0u)
        << prefix;
  }
  bool set(std::string_view name, std::string_view field, Value value) {
    return browser.set(node(name), field, std::move(value));
  }
  std::string get(std::string_view name, std::string_view field) {
    return textOf(browser.get(node(name), field));
  }
  std::vector<std::string> take() { return std::exchange(events, {}); }

  // declared before the browser, because listeners write here until it is destroyed
  std::vector<std::string> events;
  Browser browser;
};

using Log = std::vector<std::string>;

} // namespace xvrml
