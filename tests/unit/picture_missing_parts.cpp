// picture_missing_parts.cpp: Tests which sizes names of KiCad's models state.
#include <gtest/gtest.h>

#include "libpicture/kicad_materials.h"
#include "libpicture/missing_parts.h"

namespace picture {
namespace {

TEST(MissingParts, NamesStateSizes) {
  const auto is = [](const char* name, float x, float y, float z) {
    const auto size = sizeInName(name);
    ASSERT_TRUE(size) << name;
    EXPECT_FLOAT_EQ(size->x, x) << name;
    EXPECT_FLOAT_EQ(size->y, y) << name;
    EXPECT_FLOAT_EQ(size->z, z) << name;
  };
  is("shapes3D/SOIC-8_3.9x4.9mm_P1.27mm.wrl", 3.9f, 4.9f, 1.95f);
  is("R_0805_2012Metric.wrl", 2, 1.2f, .6f);
  is("LED_D5.0mm.wrl", 5, 5, 2.5f);
  is("QFN-32-1EP_5x5mm_P0.5mm.wrl", 5, 5, 2.5f);
  is("L_12x12x6mm.wrl", 12, 12, 6);
  is("C:\\parts\\CP_Radial_D10.0mm_P5.00mm.wrl", 10, 10, 5);
}

TEST(MissingParts, OtherNamesStateNone) {
  for (const char* name : {"", "Metric", "0Metric", "R_00aaMetric", "R_0000Metric",
                           "PinHeader_1x04", "P2.54mm", "X_1e9x1e9mm", "X_0x0mm", "X_infxinfmm",
                           "X_.x4mm", "D.mm", "3x", "3x4", "3x4x5x6mm", "12x34mm/plain.wrl"})
    EXPECT_FALSE(sizeInName(name)) << name;
}

TEST(KicadMaterials, TheNearestColourThatIsAsClearWins) {
  EXPECT_EQ(kicadMaterialOf({.7f, .1f, .05f}, 0).name, "RED-BODY");
  EXPECT_EQ(kicadMaterialOf({.7f, .1f, .05f}, .15f).name, "LED-RED");
  EXPECT_EQ(kicadMaterialOf({.4f, .7f, .15f}, 0).name, "LED-GREEN"); // no other has this colour
  EXPECT_EQ(kicadMaterialOf({.5f, .5f, .5f}, 0).name, "");
  EXPECT_EQ(kicadMaterialOf({0, 0, 0}, 0).name, "");
  EXPECT_FALSE(kicadMaterialOf({.824f, .82f, .781f}, 0).colour);
  const KicadMaterial linear = kicadMaterialOf({.645f, .6387f, .5721f}, 0);
  EXPECT_EQ(linear.name, "PIN-01");
  ASSERT_TRUE(linear.colour);
  EXPECT_FLOAT_EQ(linear.colour->r, .824f);
}

} // namespace
} // namespace picture
