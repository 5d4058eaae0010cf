// xvrml_off.cpp: OFF as a world: the nodes that it becomes, places in messages, early ends and
// damaged bytes. The values follow from the text by hand.
#include <gtest/gtest.h>

#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> load(const std::string& text, const LoadOptions& options = {}) {
  return loadWorldFromMemory(text, "a.off", options);
}

std::string messages(const World& world) {
  std::string all;
  for (const Diagnostic& one : world.diagnostics.list())
    all += one.text().substr(0, one.text().find('\n')) + '\n';
  return all;
}

template <class T> T* geometry(const World& world) {
  auto* shape = world.scope.roots.empty() ? nullptr : nodeCast<nodes::Shape>(world.scope.roots[0]);
  return shape ? nodeCast<T>(shape->geometry) : nullptr;
}

const std::string threePoints = "0 0 0\n1 0 0\n0 1 0\n";

TEST(Off, FacesBecomePolygons) {
  const auto world = load("OFF\n3 2 3\n" + threePoints + "3 0 1 2\n3 2 1 0\n");
  EXPECT_EQ(messages(*world), "");
  EXPECT_EQ(world->head.version.encoding, Encoding::off);
  auto* faces = geometry<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(faces);
  EXPECT_EQ(nodeCast<nodes::Coordinate>(faces->coord)->point,
            (MFVec3f{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(faces->coordIndex, (MFInt32{0, 1, 2, -1, 2, 1, 0, -1}));
  EXPECT_TRUE(faces->convex);
  EXPECT_FALSE(faces->color);
}

TEST(Off, ColoursOfFacesAreIntegersTo255OrNumbersTo1) {
  const auto world = load("OFF 3 4 0\n" + threePoints +
                          "3 0 1 2\n3 0 1 2 255 0 51\n3 0 1 2 0. 1. .5 1.\n3 0 1 2 4\n");
  EXPECT_EQ(messages(*world), "a.off:8:9: warning: 1 colours are indices of a map that is not in "
                              "the file: these faces are grey\n");
  auto* faces = geometry<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(faces);
  EXPECT_FALSE(faces->colorPerVertex);
  EXPECT_EQ(nodeCast<nodes::Color>(faces->color)->color,
            (MFColor{{.8f, .8f, .8f}, {1, 0, .2f}, {0, 1, .5f}, {.8f, .8f, .8f}}));
}

TEST(Off, CommentsMayStandDirectlyBehindNumbers) {
  const auto world = load("OFF#a\n3 1 0#b\n0 0 0#c\n1 0 0 #d\n0 1 0#\n3 0 1 2#e\n");
  EXPECT_EQ(messages(*world), "");
  EXPECT_TRUE(geometry<nodes::IndexedFaceSet>(*world));
  EXPECT_NE(messages(*load("OFF\n3 1 0\n0 0 1.#INF\n1 0 0\n0 1 0\n3 0 1 2\n")).find("expected a"),
            std::string::npos);
}

TEST(Off, OpacitiesAreNotUsed) {
  const auto world = load("OFF 3 1 0\n" + threePoints + "3 0 1 2 255 0 51 128\n");
  EXPECT_EQ(messages(*world),
            "a.off:5:9: warning: 1 colours have an opacity below 1, which is not used\n");
}

TEST(Off, PrefixesSayWhatVerticesHold) {
  const auto world =
      load("STCNOFF\n3 1 0\n0 0 0 0 0 1 1. 0. 0. 1. .25 .5\n1 0 0 0 0 1 0. 1. 0. 1. 0 0\n"
           "0 1 0 0 0 1 0. 0. 1. 1. 1 1\n3 0 1 2\n");
  EXPECT_EQ(messages(*world), "");
  auto* faces = geometry<nodes::IndexedFaceSet>(*world);
  ASSERT_TRUE(faces);
  EXPECT_EQ(nodeCast<nodes::Normal>(faces->normal)->vector[2], (Vec3f{0, 0, 1}));
  EXPECT_EQ(nodeCast<nodes::Color>(faces->color)->color[1], (Color{0, 1, 0}));
  EXPECT_EQ(nodeCast<nodes::TextureCoordinate>(faces->texCoord)->point[0], (Vec2f{.25f, .5f}));
}

TEST(Off, MessagesNameThePlace) {
  EXPECT_NE(messages(*load("OFF\n3 1 0\n0 0 0\n1 nan 0\n"))
                .find("a.off:4:3: error: expected a "
                      "number, found 'nan'"),
            std::string::npos);
  EXPECT_NE(messages(*load("OFF\n3 1 0\n" + threePoints + "3 0 1 -2\n"))
                .find("a.off:6:1: error: 1 faces"),
            std::string::npos);
  EXPECT_NE(messages(*load("OFF\n3 x 0\n")).find("a.off:2:3: error: expected the numbers"),
            std::string::npos);
}

TEST(Off, EveryEarlyEndKeepsWhatWasRead) {
  const std::string whole = "OFF\n3 2 3\n" + threePoints + "3 0 1 2\n3 2 1 0\n";
  for (size_t bytes = 8; bytes < whole.size(); ++bytes) {
    const auto world = load(whole.substr(0, bytes));
    const bool complete = bytes + 1 >= whole.size();
    EXPECT_EQ(world->diagnostics.errors() == 0, complete) << bytes << ' ' << messages(*world);
  }
}

TEST(Off, DamagedBytesAreReportedAndDoNoHarm) {
  const std::string whole =
      "COFF\n3 2 3\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2\n3 2 1 0\n";
  for (size_t at = 0; at < whole.size(); ++at)
    for (const char c : {'\0', '-', '9', '\n', '#', '\xff'}) {
      std::string damaged = whole;
      damaged[at] = c;
      try {
        writeWorld(*load(damaged));
      } catch (const LoadError&) {}
    }
}

TEST(Off, HugeCountsTakeNoMemory) {
  LoadOptions small;
  small.limits.worldBytes = 1 << 20;
  const auto world = load("OFF\n500000000 4000000000 0\n0 0 0\n", small);
  EXPECT_NE(messages(*world).find("it announces 500000000 vertices and has 1"), std::string::npos)
      << messages(*world);
  EXPECT_NE(messages(*load("OFF\n3 1 0\n" + threePoints + "2000000000 0 1 2\n")).find("1 faces"),
            std::string::npos);
}

} // namespace
