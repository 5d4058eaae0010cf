// script_abi.cpp: the script ABI: the sizes and offsets that plug-ins of this major version were
// built with, and how the host treats older and bad plug-ins. See xvrml/xscript.h.
#include <cstddef>
#include <functional>

#include <gtest/gtest.h>

#include "script/plugin_check.h"

namespace xvrml {
namespace {

// On 64-bit machines. These numbers never change; new members are added at the end.
static_assert(sizeof(void*) != 8 ||
              (sizeof(XsString) == 16 && sizeof(XsImage) == 24 && sizeof(XsValue) == 16 &&
               offsetof(XsValue, of) == 8 && sizeof(XsField) == 16 && sizeof(XsPlugin) == 24 &&
               offsetof(XsPlugin, engines) == 16));
static_assert(sizeof(void*) != 8 ||
              (offsetof(XsScriptInfo, self) == 8 && offsetof(XsScriptInfo, text) == 32 &&
               offsetof(XsScriptInfo, fields) == 56 && offsetof(XsScriptInfo, memory) == 64));
static_assert(sizeof(void*) != 8 || (offsetof(XsEvent, value) == 16 &&
                                     offsetof(XsEvent, time) == 32 && sizeof(XsEvent) >= 40));
static_assert(sizeof(void*) != 8 ||
              (offsetof(XsEngine, name) == 8 && offsetof(XsEngine, create) == 48 &&
               offsetof(XsEngine, tick) == 96 && sizeof(XsEngine) >= 104));
static_assert(sizeof(void*) != 8 ||
              (offsetof(XsHost, send) == 8 && offsetof(XsHost, read) == 24 &&
               offsetof(XsHost, lastError) == 8 + 8 * 24 && sizeof(XsHost) >= 208));
static_assert(XS_SFBOOL == 1 && XS_MFCOLOR == 12 && XS_MFVEC3F == 20 && XS_MFBOOL == 21 &&
              XS_MFVEC4F == 42 && XS_EVENT_OUT == 4 && XS_FAILED == 6);

XsResult create(const XsHost*, const XsScriptInfo*, XsInterpreter*) { return XS_OK; }
void destroy(XsInterpreter) {}
XsResult tick(XsInterpreter, double) { return XS_OK; }

const char* const schemes[] = {"abc", nullptr};

XsEngine goodEngine() {
  XsEngine engine{};
  engine.size = sizeof(XsEngine);
  engine.name = "abc";
  engine.schemes = schemes;
  engine.create = create;
  engine.destroy = destroy;
  engine.tick = tick;
  return engine;
}

// Returns the message, or "" if the plug-in is accepted.
std::string refusal(const std::function<void(XsPlugin&, XsEngine&)>& change,
                    std::vector<XsEngine>* accepted = nullptr) {
  XsEngine engine = goodEngine();
  const XsEngine* engines[] = {&engine, &engine};
  XsPlugin plugin{XS_MAGIC, XS_ABI_MAJOR, XS_ABI_MINOR, sizeof(XsPlugin), 1, engines};
  change(plugin, engine);
  try {
    const std::vector<XsEngine> result = checkScriptPlugin(&plugin, sizeof plugin, "abc.so");
    if (accepted) *accepted = result;
  } catch (const std::runtime_error& error) { return error.what(); }
  return {};
}

TEST(ScriptAbi, AShorterEngineLacksTheLastFunctions) {
  std::vector<XsEngine> engines;
  EXPECT_EQ(refusal([](XsPlugin&, XsEngine& engine) { engine.size = offsetof(XsEngine, tick); },
                    &engines),
            "");
  ASSERT_EQ(engines.size(), 1u);
  EXPECT_EQ(engines[0].size, sizeof(XsEngine));
  EXPECT_EQ(engines[0].create, create);
  EXPECT_EQ(engines[0].tick,
            nullptr); // present in the plug-in's memory, but beyond the stated size
  EXPECT_STREQ(engines[0].text, "");
}

TEST(ScriptAbi, RefusalsNameWhatIsWrong) {
  static const char* const upper[] = {"ABC", nullptr};
  static const char* const drive[] = {"c", nullptr};
  static const char* const blank[] = {"", nullptr};
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != text.npos;
  };
  EXPECT_EQ(refusal([](XsPlugin& p, XsEngine&) {
              p.major = 7;
              p.minor = 3;
            }),
            "script library abc.so: made for script ABI 7.3; this library has 1.0");
  EXPECT_TRUE(has(refusal([](XsPlugin& p, XsEngine&) { p.magic = 1; }), "wrong magic number"));
  EXPECT_TRUE(
      has(refusal([](XsPlugin& p, XsEngine&) { p.size += 8; }), "claims a plug-in structure of"));
  EXPECT_TRUE(
      has(refusal([](XsPlugin& p, XsEngine&) { p.engineCount = 0; }), "claims 0 script engines"));
  EXPECT_TRUE(has(refusal([](XsPlugin& p, XsEngine&) { p.engineCount = 1000000; }),
                  "claims 1000000 script engines"));
  EXPECT_TRUE(
      has(refusal([](XsPlugin& p, XsEngine&) { p.engines = nullptr; }), "claims 1 script engines"));
  EXPECT_TRUE(has(refusal([](XsPlugin&, XsEngine& e) { e.size = 8; }),
                  "claims an engine structure of 8 bytes"));
  EXPECT_TRUE(
      has(refusal([](XsPlugin&, XsEngine& e) { e.size += 8; }), "claims an engine structure of"));
  EXPECT_TRUE(has(refusal([](XsPlugin&, XsEngine& e) { e.name = ""; }), "without a name"));
  EXPECT_TRUE(has(refusal([](XsPlugin&, XsEngine& e) { e.destroy = nullptr; }),
                  "lacks the function destroy"));
  EXPECT_TRUE(
      has(refusal([](XsPlugin&, XsEngine& e) { e.schemes = nullptr; }), "serves no URL scheme"));
  EXPECT_TRUE(has(refusal([](XsPlugin&, XsEngine& e) { e.schemes = upper; }), "'ABC' is no name"));
  EXPECT_TRUE(has(refusal([](XsPlugin&, XsEngine& e) { e.schemes = drive; }), "'c' is no name"));
  EXPECT_TRUE(has(refusal([](XsPlugin&, XsEngine& e) { e.mimeTypes = blank; }), "'' is no name"));
}

} // namespace
} // namespace xvrml
