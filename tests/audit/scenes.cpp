// scenes.cpp: the first scenes of the audit, small ones, one for each kind of difficulty, drawn
// through the public C API. Limits of the library may be chosen from their results, as from those
// of training_scenes.cpp, but not from those of judging_scenes.cpp.
#include <cmath>

#include "audit/coverage.h"
#include "audit/scene_parts.h"

#include "openrt/openrt.h"

namespace audit {
namespace {

// Slanted stripes, a few pixels wide: some pixels have edges, others have none.
void drawEdges() {
  const RTid white = diffuse(1, 0), grey = diffuse(.25f, 0);
  square(grey, 20);
  for (int i = -8; i <= 8; i++) {
    rtPushMatrix();
    rtRotated(23, 0, 0, 1);
    rtTranslated(.437 * i, 0, .1);
    rtScaled(.01, 1, 1);
    square(white, 10);
    rtPopMatrix();
  }
  lookDown(2);
}

// A closed box that emits light: the radiance is .5 / (1 - .5) = 1 everywhere.
void drawFurnace() {
  const RTid wall = diffuse(.5f, .5f);
  for (int i = 0; i < 6; i++) {
    rtPushMatrix();
    if (i < 4)
      rtRotated(90 * i, 1, 0, 0);
    else
      rtRotated(i == 4 ? 90 : -90, 0, 1, 0);
    rtTranslated(0, 0, -1);
    square(wall, 1);
    rtPopMatrix();
  }
  rtPushMatrix();
  rtPerspective(60);
  rtPopMatrix();
}

// A lamp that faces a floor. The camera looks past the lamp.
void lampOver(double half, double height, float radiance) {
  square(diffuse(0, .5f), 10);
  rtPushMatrix();
  rtTranslated(0, 0, height);
  rtRotated(180, 1, 0, 0);
  square(diffuse(radiance, 0), half);
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(-1.5, 0, .5);
  rtRotated(-60, 0, 1, 0);
  rtPerspective(50);
  rtPopMatrix();
}
void drawLamp() { lampOver(1, 1, 1); }
void drawSmallLamp() { lampOver(.15, 1, 40); }
void drawTinyLamp() { lampOver(.03, 1, 1000); }

// A room with a lamp in its ceiling: interreflection between coloured walls, edges, shadows.
void drawRoom() {
  const RTid white = diffuse(0, .7f), dark = diffuse(0, .2f), lamp = diffuse(8, 0);
  roomOf(white, white, dark, dark, white);
  rtPushMatrix();
  rtTranslated(0, .99, 0);
  rtRotated(90, 1, 0, 0);
  square(lamp, .4);
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(-.3, -.5, -.2);
  rtRotated(20, 0, 1, 0);
  square(white, .4);
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(0, 0, 2.9);
  rtPerspective(40);
  rtPopMatrix();
}

// The Cornell box in its usual proportions: red and green walls, two white boxes, a lamp in the
// ceiling.
void drawCornell() {
  const RTid white = paint(.73f, .73f, .73f), red = paint(.65f, .05f, .05f),
             green = paint(.12f, .45f, .15f);
  roomOf(white, white, red, green, white);
  lampAbove(0, .998, 0, .24, 17);
  put(box(white, .3, .6, .3), -.33, -.4, -.3, 17);
  put(box(white, .3, .3, .3), .35, -.7, .3, -18);
  eyeAt(0, 0, 3.8, 37);
}

// A glass ball on a floor under a lamp. Its caustic is found only by paths that hit the lamp by
// chance.
void drawGlassBall() {
  floorAt(-1, paint(.6f, .6f, .5f), 6);
  lampAbove(.8, 3, -.5, .6, 10);
  put(ball(rtNewShader(rtNewShaderClass("Glass", nullptr)), .8f), 0, -.2, 0, 0);
  eyeAt(1.5, 1.6, 4, 38);
}

// Many instances of two objects in rows, under an environment light and a lamp.
void drawClutter() {
  const RTid env = rtNewShader(rtNewShaderClass("VRML97Environment", nullptr));
  const float sky[] = {.5f, .7f, 1, .9f, .9f, .8f}, angle[] = {1.57f};
  rtBindShader(env);
  rtParameterfv(rtParameterHandle("skyColor"), 6, sky);
  rtParameterfv(rtParameterHandle("skyAngle"), 1, angle);
  rtBindShader(0);
  rtUseEnvironment(env);
  floorAt(0, paint(.5f, .45f, .4f), 30);
  const RTid cube = box(paint(.7f, .3f, .1f), .12, .25, .12),
             marble = ball(paint(.2f, .3f, .7f), .17f);
  for (int i = 0; i < 100; i++) {
    const double x = (i % 10 - 4.5) * .5, z = (i / 10 - 4.5) * .5;
    put(i * 7 % 3 ? cube : marble, x + .1 * std::sin(i * 1.7), i * 7 % 3 ? .25 : .17,
        z + .1 * std::cos(i * 2.3), 37. * i);
  }
  lampAbove(-2, 2.5, 1, .5, 6);
  eyeAt(2.5, 2.2, 3.5, 40);
}

// A floor with a chequered texture, seen at a grazing angle, under a lamp.
void drawTexture() {
  RTid texture = 0;
  rtGenTextures(1, &texture);
  rtBindTexture(texture);
  const float texels[4] = {.1f, .9f, .9f, .1f};
  rtTexImage2D(1, 2, 2, RT_FLOAT, texels);
  rtTexParameteri(RT_TEXTURE_MAG_FILTER, RT_NEAREST);
  const RTid shader = diffuse(0, 1);
  rtBindShader(shader);
  rtParameterTexture(rtParameterHandle("texture"), texture);
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  for (int i = 0; i < 4; i++) {
    const int x = i == 1 || i == 2 ? 1 : -1, z = i >= 2 ? -1 : 1;
    rtTexCoord2f(6.f * float(x), 6.f * float(z));
    rtVertex3d(5 * x, 0, 5 * z);
  }
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  rtInstantiateObject(object);
  lampAbove(0, 2, -1, .8, 5);
  eyeAt(.7, 1.2, 4, 45);
}

// Fifty small lamps over objects that occlude them from each other.
void drawManyLamps() {
  floorAt(0, paint(.6f, .6f, .6f), 10);
  const RTid post = box(paint(.3f, .4f, .5f), .08, .6, .08);
  for (int i = 0; i < 50; i++) {
    const double x = (i % 10 - 4.5) * .6 + .1 * std::sin(3. * i), z = (i / 10 - 2) * .8;
    lampAbove(x, 1.3 + .4 * std::cos(5. * i), z, .03, float(20 + 15 * (i % 7)));
    if (i % 3 == 0) put(post, x + .3, .6, z + .2, 11. * i);
  }
  eyeAt(1, 2, 4.2, 45);
}

// A dim environment with a small bright sun, away from the zenith.
void drawSun() {
  const RTid env = rtNewShader(rtNewShaderClass("VRML97Environment", nullptr));
  const float sky[] = {600, 580, 500, .2f, .3f, .5f, .3f, .3f, .3f}, angle[] = {.04f, 3};
  rtBindShader(env);
  rtParameterfv(rtParameterHandle("skyColor"), 9, sky);
  rtParameterfv(rtParameterHandle("skyAngle"), 2, angle);
  rtBindShader(0);
  rtPushMatrix();
  rtRotated(-40, 1, 0, .4);
  rtUseEnvironment(env);
  rtPopMatrix();
  floorAt(0, paint(.5f, .5f, .5f), 10);
  put(box(paint(.7f, .5f, .3f), .4, .7, .4), -.5, .7, 0, 25);
  put(ball(paint(.3f, .6f, .4f), .5f), .8, .5, .3, 0);
  eyeAt(.5, 2, 4, 40);
}

// A mirror ball and a glass wall in a lit room: light paths via mirrors.
void drawMirrors() {
  drawCornell();
  put(ball(rtNewShader(rtNewShaderClass("Mirror", nullptr)), .3f), .3, -.1, .3, 0);
  put(box(rtNewShader(rtNewShaderClass("Glass", nullptr)), .5, .5, .03), -.3, -.3, .6, 20);
}

// A small lamp behind a pane. Lamps are not sampled through glass, so only one path in four hundred
// hits it.
void drawPane() {
  square(diffuse(0, .8f), 10);
  const RTid glass = rtNewShader(rtNewShaderClass("Glass", nullptr));
  rtPushMatrix();
  rtTranslated(0, 0, 1);
  rtRotated(180, 1, 0, 0);
  square(glass, 8);
  rtTranslated(0, 0, -.1);
  square(diffuse(1000, 0), .05);
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(0, 0, .5);
  rtPerspective(40);
  rtPopMatrix();
}

constexpr const char* edgesAlone = "pixels beside an edge that show none are not known to be exact";
constexpr const char* byChance = "light by way of glass or mirrors is met by chance";
const std::vector<Scenario> table = {
    {"edges", "stripes seen directly: the area's average alone", RT_TRANSPORT_DIRECT, 64, 16384, 0,
     .3, edgesAlone, drawEdges},
    {"furnace", "a closed box that glows, closed form", RT_TRANSPORT_PATH, 256, 0, 1, .9, "",
     drawFurnace},
    {"lamp", "a floor under a large lamp", RT_TRANSPORT_PATH, 64, 8192, 0, .9, "", drawLamp},
    {"small lamp", "a lamp that few directions meet", RT_TRANSPORT_PATH, 64, 8192, 0, .9, "",
     drawSmallLamp},
    {"tiny lamp", "a lamp that one direction in a thousand meets", RT_TRANSPORT_PATH, 64, 8192, 0,
     .8, "", drawTinyLamp},
    {"room", "light between walls, edges, soft shadows", RT_TRANSPORT_PATH, 512, 16384, 0, .9, "",
     drawRoom},
    {"cornell", "the Cornell box with its two boxes", RT_TRANSPORT_PATH, 256, 16384, 0, .85, "",
     drawCornell},
    {"glass ball", "a caustic under a glass ball", RT_TRANSPORT_PATH, 256, 16384, 0, .5, byChance,
     drawGlassBall},
    {"clutter", "a hundred instances under a sky and a lamp", RT_TRANSPORT_PATH, 128, 16384, 0, .9,
     "", drawClutter},
    {"texture", "a chequered floor seen flat", RT_TRANSPORT_PATH, 128, 8192, 0, .75, edgesAlone,
     drawTexture},
    {"lamps", "fifty small lamps, posts between them", RT_TRANSPORT_PATH, 128, 16384, 0, .8, "",
     drawManyLamps},
    {"sun", "a dim sky with a small sun", RT_TRANSPORT_PATH, 128, 16384, 0, .9, "", drawSun},
    {"mirrors", "the Cornell box with a mirror ball and a pane", RT_TRANSPORT_PATH, 256, 16384, 0,
     .5, byChance, drawMirrors},
    {"pane", "a small lamp behind glass", RT_TRANSPORT_PATH, 64, 65536, 0, .2, byChance, drawPane},
};

} // namespace

const std::vector<Scenario>& firstScenes() { return table; }

} // namespace audit
