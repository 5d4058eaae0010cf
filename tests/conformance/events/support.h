// support.h: a small world in a string, run by a Browser; events are written down as they leave.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "xvrml/browser.h"

namespace xvrml {

// Text of a single value as a test expects it: "TRUE", "3", "0.5", "1 2 3", "[1 2]".
std::string textOf(const Value& value);

class Running {
 public:
  // The clock's own numbers: epoch 0, so that tests can speak of times 0, 1, 2.
  explicit Running(const std::string& vrml, double start = 0, BrowserOptions options = {},
                   const RunOptions& run = {.epoch = 0})
      : browser(loadWorldFromMemory("#VRML V2.0 utf8\n" + vrml, "test.wrl"), std::move(options),
                start, run) {}

  Node& node(std::string_view name) { return *browser.node(name); }
  // From now on every event of name.out is appended to log as "time name.out value".
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

  std::vector<std::string> events; // before the browser: listeners write here to its end
  Browser browser;
};

using Log = std::vector<std::string>;

} // namespace xvrml
