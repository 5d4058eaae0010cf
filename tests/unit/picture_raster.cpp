// picture_raster.cpp: Tests pictures of the z-buffer against closed forms, and what it does with
// hostile worlds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "libpicture/raster/raster.h"
#include "libpicture/renderer.h"
#include "xvrml/world.h"

namespace {

using namespace picture;

constexpr int width = 64, height = 48;
constexpr double pi = 3.14159265358979323846;

std::unique_ptr<xvrml::World> worldOf(const std::string& text) {
  return xvrml::loadWorldFromMemory("#VRML V2.0 utf8\n" + text, "raster.wrl");
}

// A camera at the origin that looks along -z, with an angle of view of 90 degrees.
RasterView viewOf(bool linear = false) {
  RasterView view;
  view.camera = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, pi / 2, 0, nullptr};
  view.width = width;
  view.height = height;
  view.linear = linear;
  return view;
}

using Pixel = std::array<float, 4>;

class Drawn {
 public:
  explicit Drawn(const std::string& text, const RasterView& view = viewOf())
      : rgba(rasterize(*worldOf(text), view)), width_(view.width) {}
  Pixel operator()(int x, int y) const {
    Pixel pixel;
    std::copy_n(rgba.begin() + ptrdiff_t(4 * (size_t(y) * size_t(width_) + size_t(x))), 4,
                pixel.begin());
    return pixel;
  }
  bool isFinite() const {
    return std::all_of(rgba.begin(), rgba.end(), [](float v) { return std::isfinite(v); });
  }
  const std::vector<float> rgba;

 private:
  int width_;
};

// The direction through the centre of a pixel, with z = -1.
std::array<double, 2> through(int x, int y) {
  return {(x + 0.5 - width / 2.0) / (height / 2.0), (height / 2.0 - y - 0.5) / (height / 2.0)};
}

void expectNear(const Pixel& pixel, const Pixel& wanted, double most) {
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(pixel[i], wanted[i], most) << "component " << i;
}

// A slanted wall z = -4 + x whose vertices have the colours (x + 2) / 4 and (y + 2) / 4.
const std::string slanted = R"(
Shape { geometry IndexedFaceSet { solid FALSE
  coord Coordinate { point [ -2 -2 -6, 2 -2 -2, 2 2 -2, -2 2 -6 ] } coordIndex [ 0 1 2 3 -1 ]
  color Color { color [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] } } })";

TEST(Raster, ColoursOfVerticesAreCorrectInPerspective) {
  const Drawn drawn(slanted);
  int inside = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto [u, v] = through(x, y);
      const double t = 4 / (1 + u), px = u * t, py = v * t; // -t = -4 + u t
      if (std::abs(px) > 1.9 || std::abs(py) > 1.9) continue;
      ++inside;
      expectNear(drawn(x, y), {float((px + 2) / 4), float((py + 2) / 4), 0, 1}, 2e-4);
    }
  EXPECT_GT(inside, 200);
}

TEST(Raster, TexturesAreCorrectInPerspective) {
  // Two pixels, black and white: between their centres the picture is linear in s.
  const Drawn drawn(R"(
Shape { appearance Appearance { texture PixelTexture { image 2 1 1 0x00 0xff repeatS FALSE } }
  geometry IndexedFaceSet { solid FALSE
  coord Coordinate { point [ -2 -2 -6, 2 -2 -2, 2 2 -2, -2 2 -6 ] } coordIndex [ 0 1 2 3 -1 ]
  texCoord TextureCoordinate { point [ 0 0, 1 0, 1 1, 0 1 ] } } })");
  for (int x = 0; x < width; ++x) {
    const auto [u, v] = through(x, height / 2);
    const double t = 4 / (1 + u), s = (u * t + 2) / 4;
    if (s < 0.02 || s > 0.98 || std::abs(v * t) > 1.9) continue;
    const auto grey = float(std::min(1.0, std::max(0.0, 2 * s - 0.5)));
    expectNear(drawn(x, height / 2), {grey, grey, grey, 1}, 3e-4);
  }
}

std::string squareAt(const std::string& z, const std::string& color) {
  return "Transform { translation 0 0 " + z + R"( children Shape {
  appearance Appearance { material Material { diffuseColor 0 0 0 emissiveColor )" +
         color + " } } geometry Box { size 2 2 .01 } } }\n";
}

// Lights of X3D are irradiances for a PhysicalMaterial, whose diffuse part reflects 1/pi of them.
TEST(Raster, PhysicalMaterialsTakeIntensitiesAsIrradiances) {
  const auto seen = [](const std::string& material, const std::string& lights) {
    const auto world = xvrml::loadWorldFromMemory(
        "#X3D V4.0 utf8\nPROFILE Full\n" + lights +
            "Transform { translation 0 0 -3 children Shape { appearance Appearance { material " +
            material + " } geometry Box { size 4 4 .01 } } }",
        "raster.x3dv");
    const std::vector<float> rgba = rasterize(*world, viewOf(true));
    return double(rgba[4 * (size_t(height / 2) * width + width / 2)]);
  };
  const std::string matt = "Material { diffuseColor 1 1 1 }",
                    physical = "PhysicalMaterial { metallic 0 baseColor 1 1 1 }",
                    off = "NavigationInfo { headlight FALSE }\n",
                    sun = off + "DirectionalLight { intensity .5 }\n";
  EXPECT_NEAR(seen(matt, sun), .5, 1e-5);
  EXPECT_NEAR(seen(physical, sun) * pi, .5, .1); // with a weak highlight
  EXPECT_NEAR(seen(physical, "NavigationInfo { }\n") * pi, 1, .2);
  // The lights of a model that has none are as bright on both.
  EXPECT_NEAR(seen(physical, ""), seen(matt, ""), .2);
}

TEST(Raster, TheNearestShapeIsSeenInEitherOrder) {
  const std::string red = squareAt("-3", "1 0 0"), green = squareAt("-4", "0 1 0");
  for (const std::string& text : {red + green, green + red})
    expectNear(Drawn(text)(width / 2, height / 2), {1, 0, 0, 1}, 1e-6);
}

TEST(Raster, TheHeadlightShinesByTheCosine) {
  // A wall that is turned by 60 degrees about y.
  const Drawn drawn(R"(
Transform { translation 0 0 -5 rotation 0 1 0 1.0471976 children Shape {
  appearance Appearance { material Material { diffuseColor 1 .5 0 } }
  geometry Box { size 8 8 .001 } } })");
  expectNear(drawn(width / 2, height / 2), {0.5f, 0.25f, 0, 1}, 1e-4);
}

// The headlight shines along the line of sight on a wall that is turned by 60 degrees.
TEST(Raster, HighlightsHaveTheirExponent) {
  for (const double shininess : {0.0, 0.05}) {
    const Drawn drawn("Transform { translation 0 0 -5 rotation 0 1 0 1.0471976 children Shape { "
                      "appearance Appearance { material Material { diffuseColor 0 0 0 "
                      "specularColor .5 .5 .5 shininess " +
                      std::to_string(shininess) + " } } geometry Box { size 8 8 .001 } } }");
    EXPECT_NEAR(drawn(width / 2, height / 2)[0], 0.5 * std::pow(0.5, 128 * shininess), 2e-3);
  }
}

TEST(Raster, NormalsAreInterpolated) {
  // The normals of the left and the right edge point 60 degrees to their sides.
  const Drawn drawn(R"(
Shape { appearance Appearance { material Material { diffuseColor 1 1 1 } }
  geometry IndexedFaceSet {
  coord Coordinate { point [ -1 -1 -3, 1 -1 -3, 1 1 -3, -1 1 -3 ] } coordIndex [ 0 1 2 3 -1 ]
  normal Normal { vector [ -.8660254 0 .5, .8660254 0 .5, .8660254 0 .5, -.8660254 0 .5 ] } } })");
  for (int x = 0; x < width; ++x) {
    const double px = 3 * through(x, height / 2)[0];
    if (std::abs(px) > 0.95) continue;
    const auto lit = float(0.5 / std::hypot(0.5, 0.8660254 * px));
    EXPECT_NEAR(drawn(x, height / 2)[0], lit, 2e-4) << x;
  }
}

TEST(Raster, OneSidedFacesAreSeenFromTheFrontAlone) {
  const auto face = [](const char* fields) {
    return std::string("Shape { appearance Appearance { material Material { } } "
                       "geometry IndexedFaceSet { ") +
           fields +
           " coord Coordinate { point [ -1 -1 -3, 1 -1 -3, 1 1 -3, -1 1 -3 ] } "
           "coordIndex [ 0 1 2 3 -1 ] } }";
  };
  const auto isSeen = [&](const std::string& text) {
    return Drawn(text)(width / 2, height / 2)[3] > 0;
  };
  EXPECT_TRUE(isSeen(face("")));
  EXPECT_FALSE(isSeen(face("ccw FALSE")));
  EXPECT_TRUE(isSeen(face("ccw FALSE solid FALSE")));
  const auto mirrored = [](const std::string& text) {
    return "Transform { scale -1 1 1 children " + text + " }";
  };
  EXPECT_TRUE(isSeen(mirrored(face(""))));
  EXPECT_FALSE(isSeen(mirrored(face("ccw FALSE"))));
}

// A floor of 1e6 metres around the eye: everything below the horizon, nothing above it.
TEST(Raster, AFloorReachesFromTheEyeToTheHorizon) {
  const Drawn drawn(R"(
Transform { translation 0 -1 0 children Shape { geometry IndexedFaceSet { solid FALSE
  coord Coordinate { point [ -1e6 0 -1e6, 1e6 0 -1e6, 1e6 0 1e6, -1e6 0 1e6 ] }
  coordIndex [ 0 1 2 3 -1 ] } } })");
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      EXPECT_EQ(drawn(x, y)[3], y >= height / 2 ? 1 : 0) << x << " " << y;
}

TEST(Raster, ParallelViewsHaveOneSizeAtAllDistances) {
  RasterView view = viewOf();
  view.camera.fovy = 0;
  view.camera.height = 4;
  for (const char* z : {"-3", "-300"}) {
    const Drawn drawn(squareAt(z, "1 1 1"), view);
    int covered = 0;
    for (size_t i = 3; i < drawn.rgba.size(); i += 4) covered += drawn.rgba[i] > 0;
    EXPECT_EQ(covered, (height / 2) * (height / 2)) << z;
  }
  EXPECT_EQ(Drawn(squareAt("3", "1 1 1"), view)(width / 2, height / 2)[3], 0) << "behind the eye";
}

TEST(Raster, ClipPlanesCut) {
  const Drawn drawn("Group { children [ ClipPlane { plane 1 0 0 0 } " + squareAt("-2", "1 1 1") +
                    "] }");
  EXPECT_EQ(drawn(width / 2 + 4, height / 2)[3], 1);
  EXPECT_EQ(drawn(width / 2 - 5, height / 2)[3], 0);
}

TEST(Raster, LampsLightTheirGroups) {
  const std::string off = "NavigationInfo { headlight FALSE } ",
                    wall = "Shape { appearance Appearance { material Material { diffuseColor 1 1 1 "
                           "} } geometry Box { size 20 20 .001 } }";
  const auto middle = [&](const std::string& text) {
    return Drawn(off + text)(width / 2, height / 2)[0];
  };
  const auto away = [](const std::string& text) {
    return "Transform { translation 0 0 -5 children " + text + " } ";
  };
  EXPECT_NEAR(middle(away(wall) + "DirectionalLight { intensity .5 }"), 0.5, 1e-4);
  EXPECT_NEAR(middle(away(wall) + "Group { children DirectionalLight { intensity .5 } }"), 0, 1e-6);
  EXPECT_NEAR(middle(away("[ DirectionalLight { intensity .25 } " + wall + " ]")), 0.25, 1e-4);
  // at a distance of 5 from the wall: 1 / (1 + 5)
  EXPECT_NEAR(middle(away(wall) + "PointLight { attenuation 1 1 0 }"), 1 / 6.0, 2e-3);
  EXPECT_EQ(middle(away(wall) + "PointLight { radius 4.9 }"), 0);
  EXPECT_NEAR(middle(away(wall) + "SpotLight { direction 0 0 -1 }"), 1, 2e-3);
  EXPECT_EQ(middle(away(wall) + "SpotLight { direction 0 1 0 }"), 0);
}

TEST(Raster, ADarkWorldGetsALampAtTheEye) {
  EXPECT_GT(Drawn("NavigationInfo { headlight FALSE } Transform { translation 0 0 -5 children "
                  "Shape { appearance Appearance { material Material { } } geometry Box { } } }")(
                width / 2, height / 2)[0],
            0.5);
}

TEST(Raster, BackgroundsAreGradients) {
  const Drawn drawn("Background { skyColor [ 1 0 0, 0 0 1 ] skyAngle 1.5707963 "
                    "groundColor [ 0 0 0, 0 1 0 ] groundAngle 1.5707963 }");
  for (int y = 0; y < height; ++y) {
    const auto [u, v] = through(width / 2, y);
    const double up = std::asin(v / std::sqrt(1 + u * u + v * v)) / (pi / 2);
    if (up > 0)
      expectNear(drawn(width / 2, y), {float(up), 0, float(1 - up), 1}, 1e-4);
    else
      expectNear(drawn(width / 2, y), {0, float(1 + up), 0, 1}, 1e-4);
  }
}

TEST(Raster, FogReplacesFarColours) {
  const auto middle = [](const char* fog) {
    return Drawn(std::string(fog) + squareAt("-4.005", "1 0 0"))(width / 2, height / 2);
  };
  expectNear(middle("Fog { color 0 0 1 visibilityRange 10 }"), {0.6f, 0, 0.4f, 1}, 1e-3);
  expectNear(middle("Fog { color 0 0 1 visibilityRange 3 }"), {0, 0, 1, 1}, 1e-6);
  expectNear(middle("Fog { color 0 0 1 visibilityRange 10 fogType \"EXPONENTIAL\" }"),
             {float(std::exp(-4 / 6.0)), 0, float(1 - std::exp(-4 / 6.0)), 1}, 1e-3);
}

// ISO/IEC 19775-1 24.4.4: the nearest that is enabled counts, and clear air does, too.
TEST(Raster, LocalFogReplacesTheFogOfItsGroup) {
  const auto middle = [](const std::string& fogs) {
    return Drawn(
        "Fog { color 0 1 0 visibilityRange 10 }\nGroup { children [ LocalFog { color 0 0 1 "
        "visibilityRange 8 } Group { children [ " +
        fogs + squareAt("-4.005", "1 0 0") + " ] } ] }")(width / 2, height / 2);
  };
  expectNear(middle(""), {0.5f, 0, 0.5f, 1}, 1e-3);
  expectNear(middle("LocalFog { color 1 1 1 visibilityRange 16 }"), {1, 0.25f, 0.25f, 1}, 1e-3);
  expectNear(middle("LocalFog { enabled FALSE visibilityRange 1 }"), {0.5f, 0, 0.5f, 1}, 1e-3);
  expectNear(middle("LocalFog { color 1 1 1 }"), {1, 0, 0, 1}, 1e-6);
}

// The share of the pixels that a transparent shape is drawn in is its opacity.
TEST(Raster, TransparentShapesAreDrawnInAPartOfThePixels) {
  for (const double opacity : {0.25, 0.5, 0.75}) {
    const Drawn drawn("Transform { translation 0 0 -2 children Shape { appearance Appearance { "
                      "material Material { transparency " +
                      std::to_string(1 - opacity) + " } } geometry Box { size 99 99 1 } } }");
    double covered = 0;
    for (size_t i = 3; i < drawn.rgba.size(); i += 4) covered += double(drawn.rgba[i]);
    EXPECT_NEAR(covered / (width * height), opacity, 0.01);
  }
}

TEST(Raster, LinesAndPointsHaveTheirColours) {
  const Drawn drawn(R"(
Shape { geometry IndexedLineSet { coord Coordinate { point [ -9 0.02 -3, 9 0.02 -3 ] }
  coordIndex [ 0 1 -1 ] color Color { color [ 1 0 0, 0 1 0 ] } } }
Shape { appearance Appearance { material Material { emissiveColor 0 0 1 } }
  geometry PointSet { coord Coordinate { point 0 1 -2 } } })");
  int covered = 0;
  for (size_t i = 3; i < drawn.rgba.size(); i += 4) covered += drawn.rgba[i] > 0;
  EXPECT_EQ(covered, width + 1);
  expectNear(drawn(width / 2, height / 4), {0, 0, 1, 1}, 1e-6);
  for (int x = 0; x < width; ++x) {
    const double t = (3 * through(x, height / 2)[0] + 9) / 18;
    expectNear(drawn(x, height / 2 - 1), {float(1 - t), float(t), 0, 1}, 1e-4);
  }
}

TEST(Raster, ColoursAreDecodedWhereLightIsAddedLinearly) {
  EXPECT_NEAR(Drawn(squareAt("-3", ".5 .5 .5"), viewOf(true))(width / 2, height / 2)[0], 0.21404,
              1e-4);
}

TEST(Raster, HostileWorldsEndInNumbers) {
  const std::string faces = "geometry IndexedFaceSet { solid FALSE coordIndex [ 0 1 2 -1 ] coord "
                            "Coordinate { point [ ";
  for (const std::string& text : {
           "Shape { " + faces + "-1e30 -1e30 -1e30, 1e30 -1e30 -1e30, 0 1e30 -1e30 ] } } }",
           "Shape { " + faces + "3e38 3e38 3e38, -3e38 3e38 -3e38, 0 -3e38 -1 ] } } }",
           "Shape { " + faces + "0 0 0, 0 0 0, 0 0 0 ] } } }",
           "Shape { " + faces + "0 0 0, 1 0 -1, 0 1 -1 ] } } }", // through the eye
           "Shape { " + faces + "1e-40 0 -1e-40, 0 1e-40 -1e-40, 0 0 -1e-40 ] } } }",
           "Transform { scale 1e30 1e30 1e30 children Shape { " + faces +
               "-1 -1 -1, 1 -1 -1, 0 1 -1 ] } } } }",
           std::string("Transform { scale 0 1 1 children Shape { geometry Box { } } }"),
           std::string("Shape { geometry Sphere { radius 10 } }"), // the eye is within
           std::string("PointLight { location 0 0 -2 attenuation 0 0 0 radius 1e30 } "
                       "Transform { translation 0 0 -2 children Shape { appearance Appearance { "
                       "material Material { shininess 1 specularColor 1 1 1 } } "
                       "geometry Sphere { radius .5 } } }"),
       }) {
    SCOPED_TRACE(text);
    EXPECT_TRUE(Drawn(text).isFinite());
    EXPECT_TRUE(Drawn(text, viewOf(true)).isFinite());
  }
}

TEST(Raster, UnusableCamerasSeeNothing) {
  RasterView view = viewOf();
  for (double& number : view.camera.matrix) number = NAN;
  EXPECT_EQ(Drawn(slanted, view)(width / 2, height / 2)[3], 0);
  view = viewOf();
  view.camera.fovy = 0; // a parallel view of no height
  EXPECT_EQ(Drawn(slanted, view)(width / 2, height / 2)[3], 0);
}

TEST(Raster, ThreadsDoNotChangePictures) {
  std::string text = slanted;
  for (int i = 0; i < 40; ++i)
    text += "Transform { translation " + std::to_string(i % 8 - 4) + " " +
            std::to_string(i / 8 - 2) +
            " -5 children Shape { appearance Appearance { material "
            "Material { transparency .5 } } geometry Sphere { } } }\n";
  RasterView one = viewOf(true), several = one;
  one.threads = 1;
  several.threads = 4;
  EXPECT_EQ(Drawn(text, one).rgba, Drawn(text, several).rgba);
}

// Large meshes are drawn from their node, without the normals that a crease angle asks for.
TEST(Raster, LargeMeshesHaveTheirPixels) {
  constexpr int side = 320; // 204,800 triangles
  std::string points, faces;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x)
      points +=
          std::to_string(2.0 * x / side - 1) + " " + std::to_string(2.0 * y / side - 1) + " -2,";
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int a = y * (side + 1) + x, b = a + side + 1;
      for (const auto& [i, k, m] : {std::array{a, a + 1, b}, std::array{a + 1, b + 1, b}})
        faces += std::to_string(i) + " " + std::to_string(k) + " " + std::to_string(m) + " -1 ";
    }
  const auto seen = [&](const std::string& fields) {
    const Drawn drawn(
        "Shape { appearance Appearance { material Material { diffuseColor 1 1 1 } } geometry "
        "IndexedFaceSet { creaseAngle 1 " +
        fields + " coordIndex [ " + faces + " ] coord Coordinate { point [ " + points + " ] } } }");
    int covered = 0;
    for (size_t i = 0; i < drawn.rgba.size(); i += 4)
      if (drawn.rgba[i + 3] > 0) {
        ++covered;
        EXPECT_NEAR(drawn.rgba[i], 1, 1e-5);
      }
    return covered;
  };
  EXPECT_EQ(seen(""), (height / 2) * (height / 2));
  EXPECT_EQ(seen("ccw FALSE"), 0);
  EXPECT_EQ(seen("ccw FALSE solid FALSE"), (height / 2) * (height / 2));
}

TEST(Raster, ARendererSaysWhichPicturesAreOfTheZBuffer) {
  xvrml::Browser browser(worldOf("Viewpoint { position 0 0 5 } Shape { geometry Box { } }"));
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.raster = true;
  const Picture made = Renderer(browser, settings).render({}).picture;
  EXPECT_EQ(made.note, rasterNote);
  ASSERT_EQ(made.planes.size(), 1u);
  EXPECT_EQ(made.planes.begin()->first, uint32_t(RT_RGBA));
}

} // namespace
