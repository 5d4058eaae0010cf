// mapper_hatching.cpp: FillProperties in a picture of four pixels that a square fills, with each
// kind of material, and with events that change it. Style 2 covers the left one of four pixels.
#include <string>
#include <vector>

#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

class Hatching : public MapRunning {
 protected:
  // Shows a square before blue surroundings, red where it is hatched.
  void show(const std::string& material, const std::string& fields) {
    loadX3d("NavigationInfo { headlight FALSE } Background { skyColor 0 0 1 }\n"
            "Viewpoint { position .3 .1 10 } Shape { appearance Appearance { material " +
            material + " fillProperties DEF F FillProperties { hatchColor 1 0 0 " + fields +
            " } } geometry IndexedFaceSet { coord Coordinate { point [ -9 -9 0, 9 -9 0, 9 9 0, "
            "-9 9 0 ] } coordIndex [ 0 1 2 3 -1 ] } }\n");
  }
  // Returns the largest colour of each pixel of the second row.
  std::string row() {
    mapper_->update(engine_->takeChanges());
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(4, 4, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtRender();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    std::vector<float> rgba(64);
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    std::string text;
    for (size_t x = 0; x < 4; x++) {
      const float* c = &rgba[4 * (4 + x)];
      text += c[0] > .9f ? 'R' : c[1] > .9f ? 'G' : c[2] > .9f ? 'B' : '.';
    }
    return text;
  }
  size_t messages() { return world_->diagnostics.list().size(); }
};

TEST_F(Hatching, IsDrawnOverEachMaterialAndFollowsEvents) {
  for (const char* material :
       {"Material { emissiveColor 0 1 0 }", "UnlitMaterial { emissiveColor 0 1 0 }",
        "PhysicalMaterial { baseColor 0 0 0 emissiveColor 0 1 0 }"}) {
    show(material, "hatchStyle 2");
    EXPECT_EQ(row(), "RGGG") << material;
    send("F", "filled", false);
    EXPECT_EQ(row(), "RBBB") << material << ", not filled";
    send("F", "hatched", false);
    EXPECT_EQ(row(), "BBBB") << material << ", neither";
    send("F", "filled", true);
    EXPECT_EQ(row(), "GGGG") << material << ", filled again";
    send("F", "hatched", true);
    send("F", "hatchStyle", SFInt32(6));
    EXPECT_NE(row(), "RGGG") << material << ", another style";
    EXPECT_EQ(messages(), 0u);
  }
}

TEST_F(Hatching, AnUnknownStyleIsTheFirst) {
  show("Material { emissiveColor 0 1 0 }", "hatchStyle 1");
  const std::string first = row();
  EXPECT_EQ(messages(), 0u);
  show("Material { emissiveColor 0 1 0 }", "hatchStyle 20");
  EXPECT_EQ(row(), first);
  EXPECT_EQ(messages(), 1u);
}

} // namespace
} // namespace xvrml::test
