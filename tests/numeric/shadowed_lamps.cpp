// shadowed_lamps.cpp: shadow rays towards emissive shapes end just before the sampled point, and
// emission that varies is evaluated there. Against closed forms, by path tracing.
#include "numeric/lamp_scene.h"

namespace numeric {
namespace {

// Radiance of the floor below a square lamp of side 1 at height 1, and below a ball of radius 1
// whose centre is at height 3.
constexpr double squareLamp = .75227469 / pi, ballLamp = 1.0 / 9;

class ShadowedLamps : public Lamps {
 protected:
  // A lit VRML97 material emits uniformly unless it has a texture.
  static Shader material(bool textured) {
    Shader s("VRML97");
    s.setInt("lit", 1).set("emissiveColor", {1, 1, 1}).set("diffuseColor", {0, 0, 0});
    if (textured) s.setTexture("texture", texture(1, {1}));
    return s;
  }
  static Shader unlit() {
    Shader s("VRML97");
    s.setInt("lit", 0);
    return s;
  }
  static RTid culledSquare(double half) {
    const RTid object = rtBeginObject(0);
    rtEnable(RT_CULL_FACE);
    rtBindShader(matt(0));
    rtBegin(RT_QUADS);
    for (const Vec& p : rectangle(half, 0)) rtVertex3d(p.x, p.y, p.z);
    rtEnd();
    rtDisable(RT_CULL_FACE);
    rtEndObject();
    rtBindShader(0);
    return object;
  }
};

TEST_F(ShadowedLamps, AThinCoverJustBeforeALampBlocksIt) {
  floor();
  lamp(rectangle(.5, 1));
  for (const double gap : {1e-2, 1e-4, 1e-5}) {
    const RTid cover = placeAt(1 - gap, square(matt(0), .6));
    EXPECT_EQ(lit(), 0) << gap;
    EXPECT_EQ(lit(1), 0) << gap;
    rtDeleteInstance(cover);
  }
  placeAt(1 + 1e-4, square(matt(0), .6)); // behind the lamp
  expectQ("uncovered", lit(), squareLamp, 1e-3);
}

TEST_F(ShadowedLamps, ALampIsSeenThroughCulledBacks) {
  floor();
  lamp(rectangle(.5, 1));
  const RTid faceUp = placeAt(.5, culledSquare(50));
  expectQ("back", lit(), squareLamp, 1e-3);
  placeAt(.6, culledSquare(50), true);
  EXPECT_EQ(lit(), 0) << "a front behind a back";
  rtDeleteInstance(faceUp);
  EXPECT_EQ(lit(), 0) << "a front";
}

TEST_F(ShadowedLamps, KnownAndEvaluatedEmissionAgree) {
  floor();
  for (const bool round : {false, true}) {
    double got[2];
    for (const bool textured : {false, true}) {
      rtPushMatrix();
      rtTranslated(0, 0, round ? 3 : 1);
      const RTid made = round ? ball(material(textured), 1) : place(square(material(textured), .5));
      rtPopMatrix();
      got[textured] = lit();
      expectQ(round ? "ball" : "square", got[textured], round ? ballLamp : squareLamp, 1e-3);
      rtDeleteInstance(made);
    }
    EXPECT_NEAR(got[0], got[1], 1e-5 * got[0]);
  }
}

// The radiance at x and at -x adds up to 1, so that the lamp gives half of its light.
TEST_F(ShadowedLamps, EmissionOfTexturesAndVertices) {
  floor();
  RTid stripes = 0;
  rtGenTextures(1, &stripes);
  rtBindTexture(stripes);
  const float texels[2] = {1, 0};
  rtTexImage2D(1, 2, 1, RT_FLOAT, texels);
  Shader textured = unlit();
  textured.setTexture("texture", stripes);
  for (const bool down : {false, true}) {
    const RTid first = placeAt(1, square(textured, .5), down);
    expectQ("texture", lit(), squareLamp / 2, 5e-3);
    rtDeleteInstance(first);
  }
  const RTid object = rtBeginObject(0);
  rtBindShader(unlit());
  rtBegin(RT_QUADS);
  for (const Vec& p : rectangle(.5, 1)) {
    const float c = p.x > 0 ? 1.0f : 0.0f;
    rtColor3f(c, c, c);
    rtVertex3d(p.x, p.y, p.z);
  }
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  place(object);
  expectQ("colours", lit(), squareLamp / 2, 5e-3);
}

// Everything is 1e5 from the eye, and the rays meet the lamp at a cosine of .1.
TEST_F(ShadowedLamps, AFarLampDoesNotBlockItselfAtGrazingAngles) {
  floor(30000);
  std::vector<Vec> seen = rectangle(500, 1000);
  lamp(seen, 1e4);
  for (Vec& p : seen) p.x -= 10000;
  expectQ("grazing", look(10000, 0, 1e5).g, 1e4 * polygon(seen), 5e-3);
}

// The copy has the other diagonal and the other orientation.
TEST_F(ShadowedLamps, AFaceAndItsReverseAreOneLamp) {
  floor();
  const std::vector<Vec> face = rectangle(.5, 1);
  lamp(face);
  lamp({face[3], face[2], face[1], face[0]});
  expectQ("reverse", lit(), squareLamp, 2e-3);
}

TEST_F(ShadowedLamps, AHiddenLampGivesNoLight) {
  floor();
  const RTid placed = lamp(rectangle(.5, 1));
  expectQ("shown", lit(), squareLamp, 1e-3);
  for (int i = 0; i < 2; i++) { // the first change moves the lamp to a structure of its own
    rtInstanceVisible(placed, 0);
    EXPECT_EQ(lit(), 0);
    rtInstanceVisible(placed, 1);
    expectQ("shown again", lit(), squareLamp, 1e-3);
  }
}

} // namespace
} // namespace numeric
