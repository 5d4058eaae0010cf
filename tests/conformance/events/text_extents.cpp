// text_extents.cpp: lineBounds, textBounds and origin of Text (ISO/IEC 19775-1 15.4.2).
#include <cmath>

#include "conformance/events/support.h"

namespace xvrml {
namespace {

const std::string x3d = "#X3D V3.3 utf8\nPROFILE Full\n";

TEST(TextExtents, AreSentAtTheStartAndWhenTheTextChanges) {
  Running r(x3d + "Shape { geometry DEF T Text { string [ \"wide\", \"i\" ] length [ 4, 3 ] } }");
  r.log("T", "textBounds");
  r.browser.tick(1);
  EXPECT_EQ(r.take().size(), 1u);
  r.browser.tick(2);
  EXPECT_EQ(r.take().size(), 0u);
  const auto lines = std::get<MFVec2f>(r.browser.get(r.node("T"), "lineBounds"));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NEAR(lines[0].x, 4, 1e-5);
  EXPECT_NEAR(lines[1].x, 3, 1e-5);
  const auto all = std::get<SFVec2f>(r.browser.get(r.node("T"), "textBounds"));
  EXPECT_NEAR(all.x, 4, 1e-5);
  EXPECT_NEAR(all.y, lines[0].y + 1, 1e-5) << "the lines are one apart";
  const auto origin = std::get<SFVec3f>(r.browser.get(r.node("T"), "origin"));
  EXPECT_EQ(origin.x, 0);
  EXPECT_GT(origin.y, 0) << "above the first baseline";
  EXPECT_LT(origin.y, lines[0].y);
  r.set("T", "set_length", MFFloat{8, 3});
  EXPECT_EQ(r.take().size(), 1u);
  EXPECT_NEAR(std::get<SFVec2f>(r.browser.get(r.node("T"), "textBounds")).x, 8, 1e-5);
  r.set("T", "set_string", MFString{});
  EXPECT_EQ(std::get<SFVec2f>(r.browser.get(r.node("T"), "textBounds")), (SFVec2f{0, 0}));
}

TEST(TextExtents, FollowTheFontStyle) {
  Running r(x3d + "Shape { geometry DEF T Text { string \"abc\" length 6 fontStyle FontStyle { "
                  "size 2 justify [ "
                  "\"MIDDLE\", \"MIDDLE\" ] } } }");
  r.browser.tick(1);
  const auto all = std::get<SFVec2f>(r.browser.get(r.node("T"), "textBounds"));
  const auto origin = std::get<SFVec3f>(r.browser.get(r.node("T"), "origin"));
  EXPECT_NEAR(all.x, 6, 1e-5);
  EXPECT_NEAR(origin.x, -3, 1e-5);
  EXPECT_NEAR(origin.y, all.y / 2, 1e-5);
}

TEST(TextExtents, WildSizesGiveZeros) {
  Running r(x3d +
            "Shape { geometry DEF T Text { string \"abc\" length 3e38 fontStyle FontStyle { size "
            "1e20 } } }\n"
            "Shape { geometry DEF U Text { string \"abc\" fontStyle FontStyle { size -1 } } }");
  r.browser.tick(1);
  for (const char* name : {"T", "U"}) {
    const auto all = std::get<SFVec2f>(r.browser.get(r.node(name), "textBounds"));
    EXPECT_TRUE(std::isfinite(all.x) && std::isfinite(all.y));
  }
}

} // namespace
} // namespace xvrml
