// judging_scenes.cpp: hard scenes that serve as the audit's test set. No limit or rule of
// libopenrt/render was chosen or changed because of their results. The scenes that may be used for
// that are in scenes.cpp and training_scenes.cpp.
#include <cmath>

#include "audit/coverage.h"
#include "audit/scene_parts.h"

namespace audit {
namespace {

// A lamp with a radius of a ten-thousandth in a room, with a glass in front of it.
void drawBulb() {
  const RTid white = paint(.7f, .7f, .7f);
  roomOf(white, white, paint(.6f, .2f, .1f), white, white);
  lampAbove(.2, .5, 0, 1e-4, 4e7f);
  put(ball(shaderOf("Glass"), .25f), .2, .1, 0, 0);
  put(box(white, .2, .4, .2), -.5, -.6, -.3, 30);
  eyeAt(0, 0, 3.4, 40);
}

// Plates of rough metal that reflect four lamps of different size.
void drawPlates() {
  static const float roughness[] = {.02f, .08f, .2f, .4f};
  for (int i = 0; i < 4; i++) {
    const RTid metal = shaderOf("Metal");
    set(metal, "roughness", roughness[i]);
    rtPushMatrix();
    rtTranslated(0, .55 * i - 1, -.25 * i);
    rtRotated(-62 + 9 * i, 1, 0, 0);
    rtScaled(1.4, .25, 1);
    square(metal, 1);
    rtPopMatrix();
  }
  static const float half[] = {.01f, .05f, .15f, .4f};
  for (int i = 0; i < 4; i++)
    put(ball(diffuse(.1f / (half[i] * half[i]), 0), half[i]), .7 * i - 1.05, 1.6, .4, 0);
  eyeAt(0, .2, 4.5, 40);
}

// A sky with a sun half a degree wide, a glass pool, a mirror and trees.
void drawNoon() {
  const float colors[] = {40000, 39000, 36000, .3f, .5f, .9f, .8f, .8f, .7f},
              angle[] = {.0046f, 1.4f};
  sky(3, colors, angle, -35, .7f);
  floorAt(-.5, paint(.4f, .35f, .3f), 20);
  put(box(shaderOf("Glass"), .8, .15, .8), .6, -.34, .3, 20);
  put(box(shaderOf("Mirror"), .02, .6, .6), -1.2, .1, 0, 30);
  const RTid trunk = box(paint(.3f, .25f, .2f), .05, .6, .05),
             crown = ball(paint(.1f, .3f, .1f), .3f);
  for (unsigned i = 0; i < 5; i++) {
    const double x = 3 * randomNumber(i, 0) - 1.5, z = -2 * randomNumber(i, 1);
    put(trunk, x, .1, z, 0);
    put(crown, x, .8, z, 0);
  }
  eyeAt(.5, 1.4, 4, 38);
}

// A bottle of absorbing glass, lit from behind, and fog in the distance.
void drawAbsorbing() {
  const RTid amber = shaderOf("RoughGlass");
  colored(amber, "absorption", .3f, 1.2f, 4);
  set(amber, "roughness", .1f);
  const RTid env = shaderOf("VRML97Environment");
  const float grey[] = {.4f, .4f, .5f};
  rtBindShader(env);
  rtParameterfv(rtParameterHandle("skyColor"), 3, grey);
  rtBindShader(0);
  colored(env, "fogColor", .4f, .4f, .5f);
  set(env, "fogRange", 12);
  rtUseEnvironment(env);
  floorAt(-1, paint(.5f, .5f, .5f), 20);
  put(ball(amber, .7f), -.6, -.3, 0, 0);
  put(box(amber, .3, .8, .3), .8, -.2, .2, 40);
  rtPushMatrix();
  rtTranslated(0, .5, -3);
  square(diffuse(4, 0), .5);
  rtPopMatrix();
  eyeAt(0, .4, 4, 40);
}

// Twigs and lights seen through a wide-open lens.
void drawTwigs() {
  const float dusk[] = {.02f, .03f, .06f};
  sky(1, dusk, nullptr, 0, 0);
  const RTid twig = box(paint(.4f, .3f, .2f), .01, 1.5, .01), bulb = ball(diffuse(60, 0), .015f);
  for (unsigned i = 0; i < 60; i++) {
    rtPushMatrix();
    rtTranslated(3 * randomNumber(i, 0) - 1.5, 2 * randomNumber(i, 1) - 1,
                 2 - 5 * randomNumber(i, 2));
    rtRotated(180 * randomNumber(i, 3), randomNumber(i, 4), 0, 1);
    rtInstantiateObject(twig);
    rtPopMatrix();
    if (i % 6 == 0)
      put(bulb, 3 * randomNumber(i, 5) - 1.5, 2 * randomNumber(i, 6) - 1, -4 * randomNumber(i, 7),
          0);
  }
  lampAbove(0, 4, 2, 1, 3);
  lensAt(0, 0, 5, 34, .12f, 4.5f);
}

// A passage with three bends. Each bend leaves a fiftieth of the light.
void drawPassage() {
  const RTid white = paint(.75f, .75f, .75f), tan = paint(.6f, .5f, .4f);
  rtPushMatrix();
  rtScaled(1, 1, 3);
  roomOf(tan, white, white, white, white);
  rtPopMatrix();
  put(box(white, .8, 1, .05), -.2, 0, 1.2, 0);
  put(box(white, .8, 1, .05), .2, 0, 0, 0);
  put(box(white, .8, 1, .05), -.2, 0, -1.2, 0);
  lampAbove(0, .95, -2.2, .3, 50);
  eyeAt(.85, .1, 2.8, 50);
}

// Sunlight through a keyhole: a dark room with a small bright patch and the light it reflects.
void drawKeyhole() {
  const RTid white = paint(.6f, .6f, .6f);
  roomOf(white, white, white, paint(.2f, .3f, .6f), white);
  rtPushMatrix(); // the front wall: four parts around a hole
  for (int i = 0; i < 4; i++) {
    rtPushMatrix();
    rtRotated(90 * i, 0, 0, 1);
    rtTranslated(.525, .475, 1);
    rtScaled(.475, .525, .01);
    rtInstantiateObject(box(white, 1, 1, 1));
    rtPopMatrix();
  }
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(1.2, 1.4, 4);
  rtRotated(160, 1, -.3, 0);
  square(diffuse(400, 0), .3);
  rtPopMatrix();
  eyeAt(.7, .3, .85, 75);
}

// A ring of polished metal on a table, with the bright curves inside it.
void drawRing() {
  floorAt(0, paint(.6f, .55f, .5f), 6);
  const RTid gold = shaderOf("Metal");
  for (int i = 0; i < 32; i++) {
    rtPushMatrix();
    rtRotated(11.25 * i, 0, 1, 0);
    rtTranslated(0, .25, -1);
    rtInstantiateObject(box(gold, .1, .25, .02));
    rtPopMatrix();
  }
  put(ball(diffuse(300, 0), .1f), 2.5, 2, 1, 0);
  eyeAt(0, 3, 2, 40);
}

} // namespace

const std::vector<Scenario>& judgingScenes() {
  static const std::vector<Scenario> table = {
      {"bulb", "a lamp of a ten-thousandth, a ball of glass", RT_TRANSPORT_PATH, 64, 65536, 0, .1,
       "", drawBulb},
      {"plates", "rough metal and lamps of four sizes", RT_TRANSPORT_PATH, 64, 32768, 0, .3, "",
       drawPlates},
      {"noon", "a sun of half a degree, glass, a mirror", RT_TRANSPORT_PATH, 64, 65536, 0, .1,
       "light is rare", drawNoon},
      {"absorbing", "rough glass that absorbs, fog", RT_TRANSPORT_PATH, 64, 32768, 0, .1, "",
       drawAbsorbing},
      {"twigs", "twigs and bulbs through a lens", RT_TRANSPORT_PATH, 64, 32768, 0, .1, "",
       drawTwigs},
      {"passage", "a passage with three bends", RT_TRANSPORT_PATH, 64, 65536, 0, .1, "",
       drawPassage},
      {"keyhole", "a room lit through a hole", RT_TRANSPORT_PATH, 64, 65536, 0, .1, "",
       drawKeyhole},
      {"ring", "a ring of metal, its caustic", RT_TRANSPORT_PATH, 64, 65536, 0, .1, "light is rare",
       drawRing},
  };
  return table;
}

} // namespace audit
