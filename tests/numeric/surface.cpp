// surface.cpp: a pixel's value for materials, textures, fog and transparency: V7, V9 and V10 of the
// accuracy catalogue, and shadows. Uses the C API and the renderer.
#include "numeric/support.h"

namespace numeric {
namespace {

using Surface = Scene;

TEST_F(Surface, V7FogOverALitSurface) {
  place(square(Shader("VRML97")));
  use(tilted(0));
  Shader air("VRML97Environment");
  air.set("fogRange", {10}).set("fogColor", {1, 1, 1});
  rtUseEnvironment(air);
  const double lit = .8;
  expectGrey(lookFrom(4), lit); // no fog type chosen
  air.setInt("fogType", 1);
  expectGrey(lookFrom(4), .6 * lit + .4);
  for (const double d : {10., 11.}) expectGrey(lookFrom(d), 1);
  air.setInt("fogType", 2);
  const auto fogged = [&](double f) { return f * lit + (1 - f); };
  expectGrey(lookFrom(4), fogged(std::exp(-4 / 6.)));
  EXPECT_NEAR(std::exp(-4 / 6.), .513417, 1e-6);
  for (const double d : {9.9, 10., 11.}) {
    const Rgba pixel = lookFrom(d);
    EXPECT_TRUE(std::isfinite(pixel.r)) << d;
    expectGrey(pixel, 1);
  }
}

TEST_F(Surface, FogIsMeasuredInItsOwnSpace) {
  place(square(Shader("VRML97")));
  use(tilted(0));
  Shader air("VRML97Environment");
  air.set("fogRange", {10}).set("fogColor", {.5, 0, 0}).setInt("fogType", 1);
  air.set("fogMatrix", {.5, 0, 0, 0, 0, .5, 0, 0, 0, 0, .5, 0, 0, 0, 0, 1});
  rtUseEnvironment(air);
  expectColor(lookFrom(4), {.8 * .8 + .2 * .5, .8 * .8, .8 * .8});
}

// The fog of an instance replaces that of the environment, and of an instance around it.
TEST_F(Surface, AnInstanceHasAFogOfItsOwn) {
  const RTid plane = square(Shader("VRML97"), 1);
  const RTid outer = rtBeginObject(0);
  const RTid inside = rtInstantiateObject(plane);
  rtTranslated(0, 2.5, 0);
  rtInstantiateObject(plane);
  rtEndObject();
  rtPushMatrix();
  rtTranslated(-2, 0, 0);
  const RTid left = place(outer);
  rtTranslated(4, 0, 0);
  place(outer);
  rtPopMatrix();
  use(tilted(0));
  const auto air = [](double red, int type) {
    return Shader("VRML97Environment")
        .set("fogRange", {50}) // look() stands 20 above the squares
        .set("fogColor", {red, 0, 0})
        .setInt("fogType", type);
  };
  const double lit = .8;
  const auto fogged = [&](double red) { return Vec{.6 * lit + .4 * red, .6 * lit, .6 * lit}; };
  rtUseEnvironment(air(.25, 1));
  expectColor(look(-2), fogged(.25));
  const RTid fog = air(1, 1);
  rtInstanceFog(left, fog);
  expectColor(look(-2), fogged(1));
  expectColor(look(2), fogged(.25));
  rtInstanceFog(inside, air(.5, 1)); // at both places, where it is the innermost
  expectColor(look(-2), fogged(.5));
  expectColor(look(2), fogged(.5));
  rtInstanceFog(inside, air(.5, 0)); // clear air
  expectGrey(look(-2), lit);
  rtInstanceFog(inside, 0);
  expectColor(look(-2), fogged(1));
  rtDeleteShader(fog);
  expectColor(look(-2), fogged(.25));
}

// The fog coordinate of vertices is the share of the fog, whatever the distance (rtFogCoordf).
TEST_F(Surface, FogCoordinatesReplaceTheDistance) {
  const Shader paint("VRML97");
  const RTid plane = rtBeginObject(0);
  rtBindShader(paint);
  rtBegin(RT_QUADS);
  for (const int x : {-1, 1})
    for (const int y : {-x, x}) {
      rtFogCoordf(x < 0 ? 0 : 2); // held in 0..1 after interpolation
      rtVertex2f(float(x), float(y));
    }
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  const RTid placed = place(plane);
  use(tilted(0));
  const auto air = [](int type) {
    return Shader("VRML97Environment")
        .set("fogRange", {30})
        .set("fogColor", {1, 0, 0})
        .setInt("fogType", type);
  };
  const double lit = .8;
  const auto fogged = [&](double share) {
    return Vec{(1 - share) * lit + share, (1 - share) * lit, (1 - share) * lit};
  };
  for (const int type : {1, 2, 3, 4}) {
    rtUseEnvironment(air(type));
    expectColor(look(-.75), fogged(.25));
    expectColor(look(-.25), fogged(.75));
    expectColor(look(.5), fogged(1));
  }
  rtUseEnvironment(air(0)); // clear air
  expectGrey(look(.5), lit);
  rtInstanceFog(placed, air(1));
  expectColor(look(-.5), fogged(.5));
}

TEST_F(Surface, FogDoesNotReachTheBackground) {
  Shader air("VRML97Environment");
  air.setList("skyColor", {.25f, .5f, .75f}).set("fogRange", {1}).setInt("fogType", 1);
  rtUseEnvironment(air);
  expectColor(lookFrom(4), {.25, .5, .75});
}

// Rows of tables 4.5 (unlit) and 4.6 (lit).
struct Row {
  int components;
  bool coloured, lit;
  Vec colour;
  double alpha;
};

TEST_F(Surface, V9EveryRowOfTheTextureTables) {
  const Vec red{1, 0, 0}, rgb{.5, .25, 1};
  const double opaque = .75, texel = .625;
  const Row rows[] = {
      {0, false, true, {.8, .8, .8}, opaque},
      {0, true, true, red, opaque},
      {1, false, true, {.4, .4, .4}, opaque},
      {1, true, true, {.5, 0, 0}, opaque},
      {2, false, true, {.4, .4, .4}, texel},
      {2, true, true, {.5, 0, 0}, texel},
      {3, false, true, rgb, opaque},
      {3, true, true, rgb, opaque},
      {4, false, true, rgb, texel},
      {4, true, true, rgb, texel},
      {0, false, false, {1, 1, 1}, 1},
      {0, true, false, red, 1},
      {1, false, false, {.5, .5, .5}, 1},
      {1, true, false, {.5, 0, 0}, 1},
      {2, false, false, {.5, .5, .5}, texel},
      {2, true, false, {.5, 0, 0}, texel},
      {3, false, false, rgb, 1},
      {3, true, false, rgb, 1},
      {4, false, false, rgb, texel},
      {4, true, false, rgb, texel},
  };
  const RTid textures[] = {0, texture(1, {.5f}), texture(2, {.5f, float(texel)}),
                           texture(3, {.5f, .25f, 1}), texture(4, {.5f, .25f, 1, float(texel)})};
  use(tilted(0));
  for (const Row& row : rows) {
    SCOPED_TRACE(testing::Message() << row.components << " components, colours " << row.coloured
                                    << ", lit " << row.lit);
    Shader s("VRML97");
    // Transparency is the material's; without one nothing is lit.
    s.set("transparency", {row.lit ? 1 - opaque : 0})
        .setInt("lit", row.lit ? 1 : 0)
        .setTexture("texture", textures[row.components]);
    const RTid instance = place(square(s, 10, row.coloured ? &red : nullptr));
    const Rgba pixel = look();
    expectColor(pixel,
                {row.alpha * row.colour.x, row.alpha * row.colour.y, row.alpha * row.colour.z});
    expectClose(pixel.a, row.alpha);
    rtDeleteInstance(instance);
  }
}

TEST_F(Surface, TextureCoordinatesReachTheTexels) {
  RTid id = 0;
  rtGenTextures(1, &id);
  rtBindTexture(id);
  const float texels[12] = {1, 0, 0, 0, 1, 0,
                            0, 0, 1, 1, 1, 0}; // bottom row red, green; top row blue, yellow
  rtTexImage2D(3, 2, 2, RT_FLOAT, texels);
  rtTexParameteri(RT_TEXTURE_MAG_FILTER, RT_NEAREST);
  place(square(Shader("VRML97").setInt("lit", 0).setTexture("texture", id)));
  expectColor(look(-5, -5), {1, 0, 0});
  expectColor(look(5, -5), {0, 1, 0});
  expectColor(look(-5, 5), {0, 0, 1});
  expectColor(look(5, 5), {1, 1, 0});
}

TEST_F(Surface, TextureTransformMovesThePicture) {
  RTid id = 0;
  rtGenTextures(1, &id);
  rtBindTexture(id);
  const float texels[2] = {.25f, .75f};
  rtTexImage2D(1, 2, 1, RT_FLOAT, texels);
  rtTexParameteri(RT_TEXTURE_MAG_FILTER, RT_NEAREST);
  Shader s("VRML97");
  s.setInt("lit", 0).setTexture("texture", id);
  s.set("textureTransform", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, .5, 0, 0, 1});
  place(square(s));
  expectGrey(look(-5, 0), .75);
  expectGrey(look(5, 0), .25);
}

TEST_F(Surface, BilinearBetweenTexels) {
  RTid id = 0;
  rtGenTextures(1, &id);
  rtBindTexture(id);
  const float texels[2] = {0, 1};
  rtTexImage2D(1, 2, 1, RT_FLOAT, texels);
  place(square(Shader("VRML97").setInt("lit", 0).setTexture("texture", id)));
  expectGrey(look(-5, 0), 0);
  expectGrey(look(0, 0), .5);
  expectGrey(look(2.5, 0), .75);
}

TEST_F(Surface, V10TransparencyOverABackground) {
  place(square(Shader("VRML97").set("transparency", {.3}).set("emissiveColor", {1, 0, 0})));
  Rgba pixel = look();
  expectColor(pixel, {.7, 0, 0});
  expectClose(pixel.a, .7);
  rtUseEnvironment(Shader("VRML97Environment").setList("skyColor", {1, 1, 1}));
  pixel = look();
  expectColor(pixel, {1, .3, .3});
  expectClose(pixel.a, 1);
}

TEST_F(Surface, LayersOfGlassMultiply) {
  const RTid pane =
      square(Shader("VRML97").set("transparency", {.5}).set("diffuseColor", {0, 0, 0}));
  for (int k = 1; k <= 4; k++) {
    rtPushMatrix();
    rtTranslated(0, 0, k);
    place(pane);
    rtPopMatrix();
  }
  place(square(Shader("VRML97").set("emissiveColor", {1, 1, 1})));
  expectGrey(look(), 1 / 16.);
}

TEST_F(Surface, ShadowsStopTheDirectPart) {
  const RTid plane = square(Shader("VRML97"));
  place(plane);
  rtPushMatrix();
  rtTranslated(4, 0,
               4); // between the light and (0, 0, 0), but not between that point and the camera
  rtScaled(.1, .1, .1);
  const RTid blocker = place(plane);
  rtPopMatrix();
  Shader light = tilted(45).set("ambientIntensity", {.5});
  use(light);
  const double ambient = .5 * .8 * .2, direct = .8 * std::sqrt(.5);
  expectGrey(look(), ambient);
  rtQuality(RT_SHADOWS, 0);
  expectGrey(look(), ambient + direct);
  rtQuality(RT_SHADOWS, 1);
  light.setInt("shadows", 0);
  expectGrey(look(), ambient + direct);
  light.setInt("shadows", 1);
  rtInstanceVisible(blocker, 0);
  expectGrey(look(), ambient + direct);
}

TEST_F(Surface, ShadowsEndAtThePointLight) {
  place(square(Shader("VRML97")));
  rtPushMatrix();
  rtTranslated(0, 0, 8); // behind the light as seen from the surface; the camera is in between
  place(square(Shader("VRML97")));
  rtPopMatrix();
  use(point({0, 0, 4}, {1, 0, 0}));
  expectGrey(look(0, 0, 6), .8);
}

TEST_F(Surface, TransparentThingsDimShadows) {
  place(square(Shader("VRML97")));
  for (const double z : {4., 5.}) {
    rtPushMatrix();
    rtTranslated(z, 0, z);
    rtScaled(.1, .1, .1);
    place(square(Shader("VRML97").set("transparency", {.5})));
    rtPopMatrix();
  }
  use(tilted(45));
  expectGrey(look(), .25 * .8 * std::sqrt(.5));
}

TEST_F(Surface, LinesAreNeitherLitNorTextured) {
  Shader s("VRML97");
  s.set("emissiveColor", {.2, .4, .6}).setTexture("texture", texture(3, {1, 0, 0}));
  const RTid object = rtBeginObject(0);
  rtBindShader(s);
  rtLineWidth(4);
  rtBegin(RT_LINES);
  rtVertex3f(-5, 0, 0);
  rtVertex3f(5, 0, 0);
  rtEnd();
  rtEndObject();
  place(object);
  use(tilted(0));
  expectColor(look(), {.2, .4, .6});
}

TEST_F(Surface, PlugInsAreFoundByTheNameOfTheirClass) {
  for (const char* library : {static_cast<const char*>(nullptr), "debug"}) {
    const RTid instance = place(square(Shader("Debug", library).setInt("show", 2)));
    use(tilted(0)); // does not change the result
    expectColor(look(-5, 2.5), {.25, .625, 0});
    rtDeleteInstance(instance);
  }
}

TEST_F(Surface, InstancesMayOverrideTheShader) {
  const RTid instance = place(square(Shader("VRML97").setInt("lit", 0)));
  expectGrey(look(), 1);
  rtInstanceShader(instance, Shader("Debug").setInt("show", 1));
  expectColor(look(), {.5, .5, 1});
  rtInstanceShader(instance, 0);
  expectGrey(look(), 1);
}

TEST_F(Surface, ParametersActOnWhatIsAlreadyThere) {
  Shader s("VRML97");
  place(square(s));
  use(tilted(0));
  expectGrey(look(), .8);
  s.set("diffuseColor", {.1, .2, .3});
  expectColor(look(), {.1, .2, .3});
  s.set("transparency",
        {.5}); // it now needs another kind of shadow ray, and the path continues behind it
  Rgba pixel = look();
  expectColor(pixel, {.05, .1, .15});
  expectClose(pixel.a, .5);
}

} // namespace
} // namespace numeric
