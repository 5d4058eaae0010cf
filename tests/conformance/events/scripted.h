// scripted.h: a small world whose Scripts are run by the test engine (plugins/script/test); what they print is kept.
#pragma once

#include <memory>

#include "conformance/events/support.h"

namespace xvrml {

struct Printed {
  std::shared_ptr<Log> lines = std::make_shared<Log>();
};

class Scripted : private Printed, public Running {
 public:
  explicit Scripted(const std::string& vrml, BrowserOptions options = {}) : Running(vrml, 0, with(std::move(options), lines)) {}

  // Lines since the last call.
  Log printed() { return std::exchange(*lines, {}); }
  // Messages of the world, since the last call: "line: text".
  Log messages() {
    Log result;
    const auto& list = browser.world().diagnostics.list();
    for (; told_ < list.size(); ++told_) result.push_back(fmt::format("{}: {}", list[told_].line, list[told_].message));
    return result;
  }

 private:
  static BrowserOptions with(BrowserOptions options, const std::shared_ptr<Log>& lines) {
    if (options.scriptPath.empty()) options.scriptPath = XVRML_TEST_SCRIPTS;
    options.print = [lines](const std::string& text) { lines->push_back(text); };
    return options;
  }
  size_t told_ = 0;
};

} // namespace xvrml
