// ecmascript_freewrl.cpp: FreeWRL's test worlds for its script field types
// (freewrl/tests/Javascript_tests in the corpus; skipped if absent). They show success by shapes
// and colours. The tests here read the same values from the nodes.
#include <cstdlib>
#include <fstream>

#include "conformance/events/ecmascript_world.h"

namespace xvrml {
namespace {

class FreeWrl : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasEcmaScript()) GTEST_SKIP() << "the ECMAScript engine is not built";
    if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no corpus";
  }
  static std::string folder() {
    const char* corpus = std::getenv("OPENRT_CORPUS");
    return std::string(corpus ? corpus : "../shared/corpus") +
           "/freewrl-tests/freewrl/tests/Javascript_tests/";
  }
  Browser& open(const char* file) { return run(loadWorld(folder() + file)); }
  Browser& read(const std::string& text) { return run(loadWorldFromMemory(text, "test.wrl")); }
  std::string get(const char* node, const char* field) {
    return textOf(browser_->get(*browser_->node(node), field));
  }
  template <class T> T value(const char* node, const char* field) {
    return std::get<T>(browser_->get(*browser_->node(node), field));
  }
  void set(const char* node, const char* field, Value value) {
    browser_->set(*browser_->node(node), field, std::move(value));
  }
  // Returns the messages of Scripts.
  std::string failures() {
    std::string out;
    for (const Diagnostic& d : browser_->world().diagnostics.list())
      if (d.severity == Severity::error && d.message.starts_with("Script")) out += d.message + "\n";
    return out;
  }

 private:
  Browser& run(std::unique_ptr<World> world) {
    BrowserOptions options;
    options.scriptPath = XVRML_SCRIPTS;
    options.scriptIsolation = BrowserOptions::Isolation::never;
    browser_ = std::make_unique<Browser>(std::move(world), options);
    return *browser_;
  }
  std::unique_ptr<Browser> browser_;
};

TEST_F(FreeWrl, MFFloat) {
  open("MFFloat.wrl").tick(0.5);
  EXPECT_EQ(get("LEFTPATH", "key"), "[0, 0.1, 1]");
  EXPECT_EQ(get("RIGHTPATH", "key"), "[0, 0.5, 1]"); // the right path reaches the colours later
  EXPECT_NE(get("LEFTAPP", "diffuseColor"), get("RIGHTAPP", "diffuseColor"));
  EXPECT_EQ(failures(), "");
}

TEST_F(FreeWrl, MFRotation) {
  open("MFRotation.wrl");
  for (int i = 0; i < 200; ++i) set("SCRIPT", "set_fraction", 0.5f);
  EXPECT_EQ(get("LEFTPATH", "keyValue"), "[0 1 0 0, 0 1 0 3.14, 0 1 0 6.28]");
  EXPECT_EQ(get("RIGHTPATH", "keyValue"), "[0 0 1 0, 0 0 1 3.14, 0 0 1 6.28]");
  EXPECT_EQ(failures(), "");
}

TEST_F(FreeWrl, SFColor) {
  Browser& browser = open("SFColor.wrl");
  for (const double time : {0.0, 0.5, 1.0, 2.0, 3.0}) {
    browser.tick(time);
    const Color c = value<Color>("MAT", "diffuseColor"), red = value<Color>("RED", "diffuseColor"),
                hsv = value<Color>("HSV", "diffuseColor");
    EXPECT_EQ(textOf(red), textOf(Color{c.r, 0, 0}));
    EXPECT_EQ(get("GREEN", "diffuseColor"), textOf(Color{0, c.g, 0}));
    EXPECT_EQ(get("BLUE", "diffuseColor"), textOf(Color{0, 0, c.b}));
    EXPECT_NEAR(value<Color>("INVERSE", "diffuseColor").g, 1 - c.g, 1e-6f);
    EXPECT_NEAR(hsv.r, red.r, 1e-6f); // follows the red box
    EXPECT_NEAR(hsv.g, 0, 1e-6f);
  }
  EXPECT_EQ(failures(), "");
}

TEST_F(FreeWrl, SFImage) {
  Browser& browser = open("SFImage.wrl");
  const Image first = value<Image>("CONE_TEXTURE", "image");
  EXPECT_EQ(first.width, 10);
  EXPECT_EQ(first.height, 10);
  EXPECT_EQ(first.components, 1);
  EXPECT_EQ(value<Image>("BOX_TEXTURE", "image").pixels, first.pixels);
  for (int i = 1; i <= 60; ++i) browser.tick(i * 0.1);
  EXPECT_NE(value<Image>("CONE_TEXTURE", "image").pixels, first.pixels);
  EXPECT_EQ(value<Image>("BOX_TEXTURE", "image").pixels,
            value<Image>("CONE_TEXTURE", "image").pixels);
  EXPECT_EQ(failures(), "");
}

TEST_F(FreeWrl, SFNode) {
  open("SFNode.wrl").tick(1);
  const NodeRef made = value<NodeRef>("BOX1", "geometry");
  ASSERT_TRUE(made);
  EXPECT_EQ(made->type().name, "Cylinder");
  EXPECT_EQ(value<NodeRef>("BOX2", "geometry"), made);
  EXPECT_EQ(value<NodeRef>("BOX4", "geometry"), made);
  EXPECT_EQ(failures(), "");
}

// Its texture coordinates are those of X3D; its messages are those of VRML97.
TEST_F(FreeWrl, SFString) {
  open("SFString.wrl");
  set("SCRIPT", "newString", std::string("SPHERE"));
  EXPECT_EQ(get("TEXT1", "string"), "[TextureCoordinateGeneratorType:, SPHERE]");
  for (int i = 1; i < 200; ++i) set("SCRIPT", "newString", std::string("SPHERE"));
  EXPECT_EQ(get("SCRIPT", "newMode"), "SPHERE-REFLECT");
  EXPECT_EQ(failures(), "");
}

TEST_F(FreeWrl, SFVec2f) {
  open("SFVec2f.wrl");
  set("TEX1", "scale", Vec2f{2, 4});
  EXPECT_EQ(get("TEX2", "translation"), "1 2");
  EXPECT_EQ(failures(), "");
}

// The file lacks directOutput TRUE, which clause 6.40 requires here and FreeWRL does not.
TEST_F(FreeWrl, AddDelRoute) {
  std::ifstream file(folder() + "addDelRoute.wrl");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const size_t script = text.find("DEF SCRIPT Script {");
  ASSERT_NE(script, text.npos);
  Browser& browser = read(text.insert(script + 19, " directOutput TRUE "));
  const auto count = [&] {
    for (int i = 0; i < 200; ++i) set("SCRIPT", "set_fraction", 0.5f);
  };
  count(); // deletes a route that does not exist
  browser.tick(1.05);
  EXPECT_EQ(get("BOX", "rotation"), "0 0 1 0");
  count(); // adds it
  browser.tick(1.1);
  const std::string turned = get("BOX", "rotation");
  EXPECT_NE(turned, "0 0 1 0");
  count(); // deletes it
  browser.tick(1.15);
  EXPECT_EQ(get("BOX", "rotation"), turned);
  EXPECT_EQ(failures(), "");
}

} // namespace
} // namespace xvrml
