// ecmascript_world.h: a small world whose Script S is ECMAScript, run in this process, and tables
// of programs with what they print. Tests are skipped if the engine is not built.
#pragma once

#include <algorithm>

#include "conformance/events/tcl_world.h"
#include "xvrml/script_engines.h"

namespace xvrml {

class EcmaWorld : public TclWorld {
 public:
  using TclWorld::TclWorld;
  static std::string script(const std::string& declared, const std::string& program,
                            const std::string& rest = "") {
    std::string text = TclWorld::script(declared, program, rest);
    return text.replace(text.find("\"tcl:") + 1, 4, "javascript:");
  }
  // Returns what was printed and the errors, one line each.
  std::string takeOutput() {
    std::string out;
    for (const Log& log : {printed(), messages()})
      for (const std::string& line : log) out += (out.empty() ? "" : "\n") + line;
    return out;
  }
};

inline bool hasEcmaScript() { return std::filesystem::exists(XVRML_SCRIPTS "/ecmascript.so"); }

// Returns whether the engine runs ECMAScript 2020 (QuickJS) and not only 5.1 (Duktape).
inline bool runsEs2020() {
  const std::vector<ScriptEngineInfo> engines = scriptEngines(engineFolders());
  const auto engine = std::find_if(engines.begin(), engines.end(), [](const ScriptEngineInfo& one) {
    return one.name == "ecmascript";
  });
  return engine != engines.end() && engine->text.find("2020") != std::string::npos;
}

// The engines' own words differ where the language leaves them open.
inline std::string wordsOf(const char* duktape, const char* quickjs) {
  return runsEs2020() ? quickjs : duktape;
}

class EcmaScript : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasEcmaScript()) GTEST_SKIP() << "the ECMAScript engine is not built";
  }
};

// One rule: a Script with these declarations, its program, and what it prints.
struct EcmaRow {
  const char* name;
  const char* declared;
  const char* program;
  const char* printed;
};
inline void PrintTo(const EcmaRow& row, std::ostream* out) { *out << row.name; }
inline std::string rowName(const testing::TestParamInfo<EcmaRow>& info) { return info.param.name; }

class EcmaRows : public testing::TestWithParam<EcmaRow> {
 protected:
  void SetUp() override {
    if (!hasEcmaScript()) GTEST_SKIP() << "the ECMAScript engine is not built";
  }
};

} // namespace xvrml
