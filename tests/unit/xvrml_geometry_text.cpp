// xvrml_geometry_text.cpp: Tests Text and FontStyle (clauses 6.22, 6.47): extents, justification,
// stretching, directions, families, hostile strings.
#include <algorithm>

#include "geometry/bounds.h"
#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

using TextNode = Made<nodes::Text>;
using Style = Made<nodes::FontStyle>;

TextNode text(MFString lines) {
  TextNode node("Text");
  node->string = std::move(lines);
  return node;
}

Box3 boxOf(TextNode& node) {
  Built built = build(node);
  expectSound(built.mesh);
  return boundsOf(built.mesh);
}

double width(const Box3& box) { return double(box.maximum.x) - box.minimum.x; }
double height(const Box3& box) { return double(box.maximum.y) - box.minimum.y; }

class GeometryText : public testing::Test {
 protected:
  void SetUp() override {
    TextNode probe = text({"I"});
    if (build(probe).mesh.kind == Mesh::Kind::empty) GTEST_SKIP() << "no font is installed";
  }
};

TEST_F(GeometryText, LiesInThePlaneAndIsTwoSided) {
  TextNode node = text({"Hello, World"});
  Mesh mesh = build(node).mesh;
  expectSound(mesh);
  EXPECT_EQ(mesh.kind, Mesh::Kind::triangles);
  EXPECT_FALSE(mesh.solid);
  for (const Vec3f& p : mesh.points) EXPECT_EQ(p.z, 0);
  for (size_t t = 0; t < mesh.indices.size() / 3; t++)
    EXPECT_GT(areaVector(mesh, t)[2], 0); // the front faces +z
  EXPECT_EQ(boundsOf(mesh).minimum.x >= -0.1, true);
}

TEST_F(GeometryText, HolesStayOpen) {
  TextNode o = text({"O"}), dot = text({"I"});
  Mesh ring = build(o).mesh;
  Box3 box = boundsOf(ring);
  // A solid ellipse would fill pi/4 of its box.
  EXPECT_LT(area(ring), 0.7 * width(box) * height(box));
  for (size_t t = 0; t < ring.indices.size() / 3; t++) { // no triangle covers the centre
    D3 n = areaVector(ring, t), a = at(ring, 3 * t),
       m = {(box.minimum.x + box.maximum.x) / 2, (box.minimum.y + box.maximum.y) / 2, 0};
    bool inside = n[2] != 0;
    for (size_t e = 0; e < 3; e++) {
      a = at(ring, 3 * t + e);
      inside = inside && crossProduct(minus(at(ring, 3 * t + (e + 1) % 3), a), minus(m, a))[2] >= 0;
    }
    EXPECT_FALSE(inside);
  }
}

TEST_F(GeometryText, SizeScalesAll) {
  TextNode small = text({"Text", "two"}), large = text({"Text", "two"});
  Style style("FontStyle");
  style->size = 10;
  large->fontStyle = style;
  Box3 a = boxOf(small), b = boxOf(large);
  EXPECT_NEAR(width(b), 10 * width(a), 1e-4);
  EXPECT_NEAR(height(b), 10 * height(a), 1e-4);
  EXPECT_GT(height(boxOf(large)), 10); // two lines of size 10
}

TEST_F(GeometryText, LinesAreASizeTimesSpacingApart) {
  Style style("FontStyle");
  style->size = 2;
  style->spacing = 1.5f;
  TextNode one = text({"H"}), two = text({"", "H"});
  one->fontStyle = two->fontStyle = style;
  EXPECT_NEAR(boxOf(one).minimum.y, 0, 1e-5) << "FIRST: the baseline";
  EXPECT_NEAR(boxOf(two).minimum.y, -3, 1e-5);
  style->topToBottom = false;
  EXPECT_NEAR(boxOf(two).minimum.y, 3, 1e-5);
}

TEST_F(GeometryText, MajorJustification) {
  auto box = [](const char* justify, bool leftToRight) {
    Style style("FontStyle");
    style->justify = {justify};
    style->leftToRight = leftToRight;
    TextNode node = text({"HHHH"});
    node->fontStyle = style;
    return boxOf(node);
  };
  Box3 begin = box("BEGIN", true), middle = box("MIDDLE", true), end = box("END", true),
       right = box("BEGIN", false);
  double bearing = begin.minimum.x; // left side bearing of the letter
  EXPECT_GT(bearing, 0);
  EXPECT_LT(bearing, 0.2);
  EXPECT_NEAR(width(begin), width(end), 1e-5);
  EXPECT_NEAR(middle.minimum.x, -middle.maximum.x, 1e-2);
  EXPECT_NEAR(end.maximum.x, -bearing, 2e-2);
  EXPECT_NEAR(right.maximum.x, -bearing, 2e-2);
  EXPECT_NEAR(box("FIRST", true).minimum.x, bearing, 1e-6);
  EXPECT_NEAR(box("", true).minimum.x, bearing, 1e-6);
  EXPECT_NEAR(box("END", false).minimum.x, bearing, 2e-2);
}

TEST_F(GeometryText, MinorJustification) {
  auto box = [](const char* minor, bool topToBottom = true) {
    Style style("FontStyle");
    style->justify = {"BEGIN", minor};
    style->topToBottom = topToBottom;
    TextNode node = text({"Hg", "Hg"});
    node->fontStyle = style;
    return boxOf(node);
  };
  // The height of an ascender.
  EXPECT_NEAR(box("FIRST").maximum.y - box("BEGIN").maximum.y, 0.93, 0.2);
  EXPECT_LT(box("BEGIN").maximum.y, 0);
  EXPECT_GT(box("BEGIN").maximum.y, -0.4);
  EXPECT_NEAR(box("MIDDLE").maximum.y + box("MIDDLE").minimum.y, 0, 0.4);
  EXPECT_GT(box("END").minimum.y, 0);
  EXPECT_LT(box("END").minimum.y, 0.2);
  EXPECT_GT(box("BEGIN", false).minimum.y, 0); // lines go up: the bottom of the first line
  EXPECT_LT(box("END", false).maximum.y, 0);
}

TEST_F(GeometryText, MaxExtentAndLength) {
  TextNode node = text({"HHHHHHHH", "H"});
  Style right("FontStyle"); // so wide that side bearings hardly matter
  node->fontStyle = right;
  double natural = width(boxOf(node));
  node->maxExtent = float(natural / 2);
  EXPECT_NEAR(width(boxOf(node)), natural / 2, 0.05 * natural);
  node->maxExtent = float(natural * 2); // longer than the text: no effect
  EXPECT_NEAR(width(boxOf(node)), natural, 1e-5);
  node->maxExtent = 0;
  node->length = {float(natural * 3)};
  EXPECT_NEAR(width(boxOf(node)), natural * 3, 0.1 * natural);
  node->length = {0, float(natural * 3)}; // 0: the natural length
  EXPECT_NEAR(width(boxOf(node)), natural * 3, natural);
  node->string = {"HHHHHHHH"};
  EXPECT_NEAR(width(boxOf(node)), natural, 1e-5);
}

TEST_F(GeometryText, VerticalText) {
  Style style("FontStyle");
  style->horizontal = false;
  TextNode node = text({"HHHH"});
  node->fontStyle = style;
  Box3 down = boxOf(node);
  EXPECT_LE(down.maximum.y, 0.01);
  EXPECT_LT(down.minimum.y, -3);
  EXPECT_GE(down.minimum.x, -0.01);
  EXPECT_LE(down.maximum.x, 1.01);
  style->topToBottom = false;
  Box3 up = boxOf(node);
  EXPECT_GE(up.minimum.y, -0.01);
  EXPECT_NEAR(height(up), height(down), 1e-5);
  style->justify = {"MIDDLE", "MIDDLE"};
  Box3 middle = boxOf(node);
  EXPECT_NEAR(middle.minimum.y, -middle.maximum.y, 0.4);
  EXPECT_NEAR(middle.minimum.x, -middle.maximum.x, 0.1);
  node->string = {"H", "H", "H"};
  style->justify = {};
  style->topToBottom = true;
  EXPECT_GT(boxOf(node).maximum.x, 2);
  style->leftToRight = false;
  EXPECT_LT(boxOf(node).minimum.x, -2);
}

TEST_F(GeometryText, TextureIsOneFontHeightAtTheFirstLinesOrigin) {
  Style style("FontStyle");
  style->size = 4;
  style->justify = {"MIDDLE", "MIDDLE"};
  TextNode node = text({"Ab", "c"});
  node->fontStyle = style;
  Mesh mesh = build(node, true).mesh;
  ASSERT_EQ(mesh.texCoords.size(), mesh.points.size());
  double s0 = mesh.points[0].x / 4 - mesh.texCoords[0].x,
         t0 = mesh.points[0].y / 4 - mesh.texCoords[0].y;
  for (size_t i = 0; i < mesh.points.size(); i++) {
    EXPECT_NEAR(mesh.texCoords[i].x, mesh.points[i].x / 4 - s0, 1e-5);
    EXPECT_NEAR(mesh.texCoords[i].y, mesh.points[i].y / 4 - t0, 1e-5);
  }
  style->justify = {};
  mesh = build(node, true).mesh;
  EXPECT_NEAR(mesh.texCoords[0].x, mesh.points[0].x / 4, 1e-6);
  EXPECT_NEAR(mesh.texCoords[0].y, mesh.points[0].y / 4, 1e-6);
}

TEST_F(GeometryText, FamiliesAndStyles) {
  auto advance = [](MFString family, const char* style, const char* string) {
    Style fontStyle("FontStyle");
    fontStyle->family = std::move(family);
    fontStyle->style = style;
    TextNode node = text({string});
    node->fontStyle = fontStyle;
    return width(boxOf(node));
  };
  // Letters of a TYPEWRITER font are equally wide, those of other fonts are not. Measured between
  // the left edges of two equal stems.
  EXPECT_NEAR(advance({"TYPEWRITER"}, "PLAIN", "HiiiiH"),
              advance({"TYPEWRITER"}, "PLAIN", "HmmmmH"), 1e-3);
  EXPECT_LT(advance({"SERIF"}, "PLAIN", "HiiiiH"), 0.8 * advance({"SERIF"}, "PLAIN", "HmmmmH"));
  EXPECT_NE(advance({"SERIF"}, "PLAIN", "Hamburg"), advance({"SANS"}, "PLAIN", "Hamburg"));
  EXPECT_NE(advance({"SANS"}, "PLAIN", "Hamburg"), advance({"SANS"}, "BOLD", "Hamburg"));
  EXPECT_GT(advance({"SANS"}, "ITALIC", "Hamburg"), 1);
  EXPECT_EQ(advance({"No Such Family Anywhere", "SANS"}, "PLAIN", "Hamburg"),
            advance({"SANS"}, "PLAIN", "Hamburg"));
  EXPECT_EQ(advance({"No Such Family Anywhere"}, "PLAIN", "Hamburg"),
            advance({"SERIF"}, "PLAIN", "Hamburg"));
}

TEST_F(GeometryText, ManyScriptsAndHostileStrings) {
  for (const char* string :
       {"Grüße Žluťoučký", "Ελληνικά", "Русский", "العربية", "日本語", "e\xcc\x81", "a\tb\nc",
        "\x01\x02", "\xff\xfe\xc0\x80", "\xf0\x9f\x98", "\xed\xa0\x80", " ", "",
        "\xe2\x80\xae"
        "abc",
        "%s%n%x"})
    for (bool horizontal : {true, false}) {
      TextNode node = text({string, "x"});
      Style style("FontStyle");
      style->horizontal = horizontal;
      style->language = string;
      style->family = {string};
      style->style = string;
      style->justify = {string, string, string};
      node->fontStyle = style;
      expectSound(build(node).mesh);
    }
  TextNode blank = text({"", "   "});
  EXPECT_EQ(build(blank).mesh.kind, Mesh::Kind::empty);
  TextNode none = text({});
  EXPECT_EQ(build(none).mesh.kind, Mesh::Kind::empty);
}

TEST_F(GeometryText, WildNumbers) {
  for (float value : {0.f, -1.f, 1e-30f, 1e30f, 3e38f, INFINITY, -INFINITY, NAN}) {
    TextNode node = text({"Wild", "numbers"});
    Style style("FontStyle");
    node->fontStyle = style;
    node->maxExtent = value;
    expectSound(build(node).mesh);
    node->length = {value, 1};
    expectSound(build(node).mesh);
    style->spacing = value;
    expectSound(build(node).mesh);
    style->spacing = 1;
    style->size = value;
    expectSound(build(node).mesh);
  }
}

TEST_F(GeometryText, LimitHolds) {
  Limits limits;
  limits.triangles = 200;
  TextNode node = text({std::string(5000, 'o')});
  Built built = build(node, false, limits);
  expectSound(built.mesh);
  EXPECT_LE(built.mesh.indices.size(), 600u);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
}

} // namespace
} // namespace xvrml::test
