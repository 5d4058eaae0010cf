// scripted.h: a small world whose Scripts are run by the test engine (plugins/script/test). What
// they print is kept. Tests of a fixture derived from ScriptsSomewhere run twice: with Scripts in
// this process and in processes of their own.
#pragma once

#include <cstdlib>
#include <memory>

#include "conformance/events/support.h"

namespace xvrml {

// Where the Scripts of the current test run. ctest runs the tests of the languages a second time
// with $XVRML_TEST_ISOLATION=always.
inline const bool everythingInProcesses = std::getenv("XVRML_TEST_ISOLATION") != nullptr;
// The folders with the project's engines. ctest runs the tests of ECMAScript a second time with
// another engine, whose folder is $XVRML_TEST_ENGINES.
inline std::string engineFolders() {
  const char* other = std::getenv("XVRML_TEST_ENGINES");
  return (other ? std::string(other) + ':' : std::string()) + XVRML_SCRIPTS;
}
inline BrowserOptions::Isolation isolationOfTest = BrowserOptions::Isolation::automatic;

class ScriptsSomewhere : public testing::TestWithParam<BrowserOptions::Isolation> {
 protected:
  void SetUp() override { isolationOfTest = GetParam(); }
  void TearDown() override { isolationOfTest = BrowserOptions::Isolation::automatic; }
};
inline std::string whereName(const testing::TestParamInfo<BrowserOptions::Isolation>& info) {
  return info.param == BrowserOptions::Isolation::always ? "process" : "here";
}
#define XVRML_SCRIPTS_SOMEWHERE(fixture)                                                           \
  INSTANTIATE_TEST_SUITE_P(                                                                        \
      Where, fixture,                                                                              \
      testing::Values(BrowserOptions::Isolation::never, BrowserOptions::Isolation::always),        \
      whereName)

inline BrowserOptions scriptOptions(BrowserOptions options = {}) {
  if (options.scriptPath.empty()) options.scriptPath = XVRML_TEST_SCRIPTS;
  if (options.scriptIsolation == BrowserOptions::Isolation::automatic)
    options.scriptIsolation = isolationOfTest;
  return options;
}

struct Printed {
  std::shared_ptr<Log> lines = std::make_shared<Log>();
};

class Scripted : private Printed, public Running {
 public:
  explicit Scripted(const std::string& vrml, BrowserOptions options = {},
                    const RunOptions& run = {.epoch = 0})
      : Running(vrml, 0, with(std::move(options), lines), run) {}

  // Returns the lines printed since the last call.
  Log printed() { return std::exchange(*lines, {}); }
  // Returns the messages of the world since the last call, as "line: text", but not those about
  // field types of X3D, which tests use in worlds of VRML97.
  Log messages() {
    Log result;
    const auto& list = browser.world().diagnostics.list();
    for (; told_ < list.size(); ++told_)
      if (list[told_].message.find("is a type of X3D") == std::string::npos)
        result.push_back(fmt::format("{}: {}", list[told_].line, list[told_].message));
    return result;
  }

 private:
  static BrowserOptions with(BrowserOptions options, const std::shared_ptr<Log>& lines) {
    options = scriptOptions(std::move(options));
    options.print = [lines](const std::string& text) { lines->push_back(text); };
    return options;
  }
  size_t told_ = 0;
};

} // namespace xvrml
