// tcl_world.h: a small world whose Scripts are Tcl, run in this process (see scripted.h). Tests are
// skipped if the engine is not built.
#pragma once

#include <filesystem>

#include "conformance/events/scripted.h"

namespace xvrml {

class TclWorld : public Scripted {
 public:
  explicit TclWorld(const std::string& vrml, BrowserOptions options = {})
      : Scripted(vrml, with(std::move(options))) {}

  // Returns a world with one Script S of these declarations and this program, which is quoted for
  // VRML.
  static std::string script(const std::string& declared, const std::string& program,
                            const std::string& rest = "") {
    std::string quoted;
    for (const char c : program) {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
    return "DEF S Script { " + declared + " url \"tcl:" + quoted + "\" } " + rest;
  }

 private:
  static BrowserOptions with(BrowserOptions options) {
    options.scriptPath = engineFolders();
    options.scriptIsolation = everythingInProcesses && !options.trustScripts
                                  ? BrowserOptions::Isolation::always
                                  : BrowserOptions::Isolation::never;
    return options;
  }
};

class Tcl : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(XVRML_SCRIPTS "/tcl.so"))
      GTEST_SKIP() << "the Tcl engine is not built";
  }
};

} // namespace xvrml
