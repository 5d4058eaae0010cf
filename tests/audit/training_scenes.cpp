// training_scenes.cpp: hard scenes of the audit from which limits may be chosen. The rules of
// libopenrt/render/film/error.cpp and error_map.cpp were developed with these scenes and those of
// scenes.cpp, and without those of judging_scenes.cpp.
#include <cmath>

#include "audit/coverage.h"
#include "audit/scene_parts.h"

namespace audit {
namespace {

// A small lamp behind a thick glass ball lights a floor. Few paths hit the lamp, and the floor has
// little other light.
void drawCaustic() {
  floorAt(-1, paint(.5f, .5f, .5f), 5);
  put(ball(shaderOf("Glass"), .6f), 0, 0, 0, 0);
  lampAbove(0, 2.4, 0, .12, 200);
  lampAbove(-3, 3, 1, .5, .05f);
  eyeAt(2.2, 1.8, 2.6, 42);
}

// A lamp one thousandth above a floor. The near end of the visible floor is lit a thousand million
// times as brightly as the far end.
void drawDecades() {
  square(diffuse(0, .6f), 10);
  rtPushMatrix();
  rtTranslated(-.46, -.44, .002);
  rtRotated(180, 1, 0, 0);
  square(diffuse(1e6f, 0), .002);
  rtPopMatrix();
  lookDown(1);
}

// Four layers of small leaves in front of a bright sky, all smaller than a pixel or two.
void drawLeaves() {
  const float bright[] = {1.5f, 1.6f, 2};
  sky(1, bright, nullptr, 0, 0);
  const RTid leaf = box(paint(.15f, .35f, .08f), .05, .03, .002);
  for (unsigned i = 0; i < 500; i++) {
    rtPushMatrix();
    rtTranslated(2.4 * randomNumber(i, 0) - 1.2, 2.4 * randomNumber(i, 1) - 1.2, -.5 * (i % 4));
    rtRotated(360 * randomNumber(i, 2), randomNumber(i, 3) - .5, randomNumber(i, 4) - .5, 1);
    rtInstantiateObject(leaf);
    rtPopMatrix();
  }
  eyeAt(0, 0, 3, 34);
}

// Five hundred lamps of very different power over boxes.
void drawFiveHundred() {
  floorAt(0, paint(.6f, .6f, .6f), 10);
  const RTid post = box(paint(.5f, .4f, .3f), .1, .4, .1);
  for (unsigned i = 0; i < 500; i++) {
    const double strength = std::exp(6 * randomNumber(i, 3));
    lampAbove(6 * randomNumber(i, 0) - 3, .6 + 1.2 * randomNumber(i, 1), 6 * randomNumber(i, 2) - 3,
              .015, float(strength));
    if (i % 25 == 0) put(post, 4 * randomNumber(i, 4) - 2, .4, 4 * randomNumber(i, 5) - 2, 11. * i);
  }
  eyeAt(1, 2, 4.2, 45);
}

// Emissive and lit balls far in front of and behind the plane of focus, on black.
void drawFocus() {
  for (unsigned i = 0; i < 12; i++) {
    const RTid shader = i % 3 == 0 ? diffuse(float(1 + i), 0) : paint(.8f, .3f, .2f);
    put(ball(shader, i % 3 == 0 ? .05f : .3f), 3 * randomNumber(i, 0) - 1.5,
        1.6 * randomNumber(i, 1) - .8, 4 - 9 * randomNumber(i, 2), 0);
  }
  lampAbove(0, 3, 1, .6, 8);
  lensAt(0, 0, 6, 30, .25f, 6);
}

// Bright stripes seen through a glass wedge of strong dispersion.
void drawDispersion() {
  const RTid glass = shaderOf("Glass");
  set(glass, "abbe", 20);
  rtPushMatrix();
  rtRotated(28, .3, 1, .1);
  rtInstantiateObject(box(glass, .8, .8, .8));
  rtPopMatrix();
  const RTid stripe = diffuse(3, 0);
  for (int i = -6; i <= 6; i++) {
    rtPushMatrix();
    rtTranslated(.5 * i, 0, -3);
    rtScaled(.04, 1, 1);
    square(stripe, 3);
    rtPopMatrix();
  }
  eyeAt(.4, .5, 4, 36);
}

// A closed room lit through a slit in its ceiling.
void drawSlit() {
  const RTid white = paint(.7f, .7f, .7f), red = paint(.6f, .1f, .1f);
  rtPushMatrix();
  rtScaled(1, 1, 1.5);
  roomOf(white, white, red, white, white);
  rtTranslated(0, 0, 1);
  rtRotated(180, 0, 1, 0);
  square(white, 1);
  rtPopMatrix();
  const RTid lid =
      box(white, .96, .02, 1.4); // hides the lamp; light arrives via the ceiling and the side
  put(lid, -.1, .6, 0, 0);
  lampAbove(-.3, .9, 0, .3, 30);
  eyeAt(.2, -.2, 1.3, 70);
}

} // namespace

const std::vector<Scenario>& trainingScenes() {
  static const std::vector<Scenario> table = {
      {"caustic", "a small lamp behind a ball of glass", RT_TRANSPORT_PATH, 64, 65536, 0, .1,
       "light is rare", drawCaustic},
      {"decades", "a floor lit over nine decades", RT_TRANSPORT_PATH, 64, 16384, 0, .5, "",
       drawDecades},
      {"leaves", "layers of small leaves before the sky", RT_TRANSPORT_PATH, 64, 16384, 0, .3, "",
       drawLeaves},
      {"500 lamps", "five hundred lamps of different strength", RT_TRANSPORT_PATH, 64, 32768, 0, .3,
       "", drawFiveHundred},
      {"focus", "depth of field: balls before and behind", RT_TRANSPORT_PATH, 64, 16384, 0, .1, "",
       drawFocus},
      {"dispersion", "stripes through a wedge of glass", RT_TRANSPORT_PATH, 64, 16384, 0, .1, "",
       drawDispersion},
      {"slit", "a room lit by way of a slit", RT_TRANSPORT_PATH, 64, 65536, 0, .1, "light is rare",
       drawSlit},
  };
  return table;
}

} // namespace audit
