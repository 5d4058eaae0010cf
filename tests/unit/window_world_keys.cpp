// window_world_keys.cpp: which keys the KeySensor or StringSensor of a world gets, which of them
// are the window's commands as well, and how scripts for --input write them.
#include <gtest/gtest.h>

#include <vector>

#include "options/values.h"
#include "session/input/input_script.h"
#include "session/input/keys.h"
#include "session/input/world_keys.h"

using namespace vv;

namespace {

InputEvent keyEvent(const std::string& name, bool shift = false, bool control = false) {
  InputEvent event;
  event.kind = InputEvent::Kind::down;
  event.text = name;
  event.shift = shift;
  event.control = control;
  return event;
}

struct World {
  explicit World(const std::string& sensor)
      : browser(xvrml::loadWorldFromMemory("#X3D V3.3 utf8\nPROFILE Immersive\n" + sensor,
                                           "test.x3dv")) {
    for (const char* out : {"keyPress", "keyRelease"})
      if (browser.node("K"))
        browser.listen(*browser.node("K"), out,
                       [this, out](xvrml::Node&, const xvrml::FieldInfo&, const xvrml::Value& v) {
                         log += std::string(out[3] == 'P' ? "+" : "-") + std::get<std::string>(v);
                       });
  }
  std::string take() { return std::exchange(log, {}); }
  std::string log;
  xvrml::Browser browser;
  WorldKeys keys;
};

} // namespace

TEST(WorldKeys, CharactersAreTheWorldsAlone) {
  World w("DEF K KeySensor { }\n");
  EXPECT_TRUE(w.keys.press(w.browser, keyEvent("S")));
  EXPECT_TRUE(w.keys.press(w.browser, keyEvent("S", true)));
  EXPECT_TRUE(w.keys.press(w.browser, keyEvent("5")));
  EXPECT_TRUE(w.keys.press(w.browser, keyEvent("Space")));
  EXPECT_TRUE(w.keys.press(w.browser, keyEvent("Return")));
  EXPECT_EQ(w.take(), "+s+S+5+ +\n");
  EXPECT_FALSE(w.keys.press(w.browser, keyEvent("Left")));
  EXPECT_FALSE(w.keys.press(w.browser, keyEvent("F1")));
  EXPECT_FALSE(w.keys.press(w.browser, keyEvent("Left Shift")));
  EXPECT_FALSE(w.keys.press(w.browser, keyEvent("Keypad Plus")));
}

TEST(WorldKeys, ThoseOfAnotherKeyboardComeAsText) {
  World w("DEF K KeySensor { }\n");
  EXPECT_TRUE(w.keys.press(w.browser, keyEvent("1", true))); // ! on some keyboards
  EXPECT_TRUE(w.keys.press(w.browser, keyEvent("\xc3\x9c")));
  EXPECT_EQ(w.take(), "");
  EXPECT_EQ(typedBy(keyEvent("1", true)), "");
  EXPECT_EQ(typedBy(keyEvent("A")), "a");
  EXPECT_EQ(typedBy(keyEvent("A", true)), "A");
  EXPECT_EQ(typedBy(keyEvent("Keypad 7")), "7");
  EXPECT_EQ(typedBy(keyEvent("Left")), "");
}

TEST(WorldKeys, CtrlMeansTheWindowsCommand) {
  World w("DEF K KeySensor { }\n");
  const InputEvent event = keyEvent("S", false, true);
  EXPECT_FALSE(w.keys.press(w.browser, event));
  EXPECT_EQ(w.take(), "");
  EXPECT_EQ(actionOf(WorldKeys::commandOf(w.browser, event)), Action::save);
  World without("Group { }\n");
  EXPECT_FALSE(without.keys.press(without.browser, keyEvent("S")));
  EXPECT_EQ(actionOf(WorldKeys::commandOf(without.browser, event)), Action::none);
}

TEST(WorldKeys, AKeyIsReleasedAsItWasPressed) {
  World w("DEF K KeySensor { }\n");
  w.keys.press(w.browser, keyEvent("A", true));
  w.keys.release(w.browser, keyEvent("A"));
  EXPECT_EQ(w.take(), "+A-A");
  w.keys.press(w.browser, keyEvent("B"));
  w.keys.press(w.browser, keyEvent("C"));
  w.keys.release(w.browser); // the window has lost the keyboard
  EXPECT_EQ(w.take(), "+b+c-b-c");
  w.keys.release(w.browser, keyEvent("B"));
  EXPECT_EQ(w.take(), "");
}

TEST(WorldKeys, ScriptsTypeTexts) {
  const InputScript script = parseInputScript("1 type \"a \\\"b\\\"\"\n2 type x\n", "test");
  ASSERT_EQ(script.events.size(), 2U);
  EXPECT_EQ(script.events[0].event.kind, InputEvent::Kind::type);
  EXPECT_EQ(script.events[0].event.text, "a \"b\"");
  EXPECT_EQ(inputLine(1, script.events[0].event), "1 type \"a \\\"b\\\"\"\n");
  EXPECT_THROW(parseInputScript("1 type\n", "test"), UsageError);
}
