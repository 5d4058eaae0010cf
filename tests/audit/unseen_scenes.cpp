// unseen_scenes.cpp: scenes that were added to the audit after all limits and rules of
// libopenrt/render had been set, and have served for none of them. They tell how far the others
// speak for scenes that nobody has looked at.
#include <cmath>

#include "audit/coverage.h"
#include "audit/scene_parts.h"

namespace audit {
namespace {

// A room behind a blind: a small sun falls through the slats, the rest is reflected light.
void drawBlind() {
  const float colors[] = {9000, 8800, 8400, .3f, .45f, .7f, .6f, .6f, .6f}, angle[] = {.01f, 1.5f};
  sky(3, colors, angle, 52, .4f);
  const RTid white = paint(.7f, .68f, .65f), wood = paint(.45f, .3f, .2f);
  roomOf(wood, white, white, paint(.3f, .4f, .3f), white);
  const RTid slat = box(white, 1, .004, .06);
  for (int i = 0; i < 14; i++) {
    rtPushMatrix();
    rtTranslated(0, -.95 + .14 * i, 1);
    rtRotated(35, 1, 0, 0);
    rtInstantiateObject(slat);
    rtPopMatrix();
  }
  put(box(paint(.6f, .6f, .2f), .25, .3, .25), -.35, -.7, -.2, 25);
  eyeAt(.3, .1, .9, 80);
}

// An exact lens that throws the image of a small slide on a wall.
void drawProjector() {
  constexpr double curvature = -1.1, conic = -.6,
                   radius = .4; // radius of both sides, which meet at the rim
  const double rim = curvature * radius * radius /
                     (1 + std::sqrt(1 - (1 + conic) * std::pow(curvature * radius, 2)));
  const RTid lens = rtBeginObject(0);
  rtBindShader(shaderOf("Glass"));
  for (int side = 0; side < 2; side++) {
    rtPushMatrix();
    rtRotated(180 * side, 0, 1, 0);
    rtTranslated(0, 0, -rim);
    rtAsphere(curvature, conic, 0, nullptr, 0, radius);
    rtPopMatrix();
  }
  rtEndObject();
  rtBindShader(0);
  put(lens, 0, 0, 0, 0);
  const RTid shade = paint(.02f, .02f, .02f);
  for (int i = 0; i < 4; i++) { // a screen around the lens
    rtPushMatrix();
    rtRotated(90 * i, 0, 0, 1);
    rtTranslated(.7, .3, 0);
    rtInstantiateObject(box(shade, .3, .7, .02));
    rtPopMatrix();
  }
  for (int i = 0; i < 3; i++) {
    rtPushMatrix();
    rtTranslated(.12 * i - .12, .05 * (i % 2), 1.6);
    rtRotated(180, 0, 1, 0);
    square(diffuse(float(20 + 20 * i), 0), .04);
    rtPopMatrix();
  }
  rtPushMatrix();
  rtTranslated(0, 0, -2.2);
  square(paint(.7f, .7f, .7f), 2);
  rtPopMatrix();
  lampAbove(0, 2.5, -1, .4, .2f);
  rtPushMatrix();
  rtLookAt(1.3, .7, -.4, 0, 0, -2.2, 0, 1, 0);
  rtPerspective(45);
  rtPopMatrix();
}

// Lacquered things on a varnished board, lit by small lamps and an evening sky.
void drawLacquer() {
  const float colors[] = {.05f, .08f, .2f, .9f, .5f, .2f}, angle[] = {1.57f};
  sky(2, colors, angle, 0, 0);
  const RTid board = shaderOf("Plastic");
  colored(board, "color", .35f, .2f, .1f);
  floorAt(0, board, 3);
  for (unsigned i = 0; i < 9; i++) {
    const RTid coat = shaderOf("Plastic");
    colored(coat, "color", float(randomNumber(i, 0)), .05f, float(randomNumber(i, 1)));
    set(coat, "roughness", i % 3 == 0 ? 0 : .12f * float(i % 3));
    put(ball(coat, .22f), .6 * (i % 3) - .6, .22, .6 * (i / 3) - .7, 0);
  }
  for (unsigned i = 0; i < 5; i++)
    put(ball(diffuse(150, 0), .03f), 2 * randomNumber(i, 2) - 1, .9 + .3 * randomNumber(i, 3),
        2 * randomNumber(i, 4) - 1, 0);
  eyeAt(.4, 1.6, 2.6, 38);
}

// A lamp in a polished cone above a table: the table has light of the bulb and of the cone.
void drawLampshade() {
  floorAt(-.8, paint(.6f, .55f, .5f), 3);
  const RTid shade = rtBeginObject(0);
  rtBindShader(shaderOf("Metal"));
  rtCone(.5, .12, 0, .5);
  rtEndObject();
  rtBindShader(0);
  put(shade, 0, .5, 0, 0);
  put(ball(diffuse(300, 0), .06f), 0, .68, 0, 0);
  put(box(paint(.2f, .4f, .6f), .2, .15, .2), .3, -.65, .2, 30);
  const float dusk[] = {.05f, .05f, .06f};
  sky(1, dusk, nullptr, 0, 0);
  eyeAt(1.4, .5, 2.6, 42);
}

// A room that has its light through a frosted pane.
void drawFrosted() {
  const RTid white = paint(.75f, .75f, .72f);
  roomOf(paint(.4f, .35f, .3f), white, paint(.6f, .25f, .2f), white, white);
  const RTid frosted = shaderOf("RoughGlass");
  set(frosted, "roughness", .3f);
  put(box(frosted, 1, 1, .02), 0, 0, 1.02, 0);
  rtPushMatrix();
  rtTranslated(-.6, 1.2, 3);
  rtRotated(160, 1, -.2, 0);
  square(diffuse(30, 0), .5);
  rtPopMatrix();
  put(box(white, .25, .25, .25), .3, -.75, -.3, 20);
  eyeAt(.2, .2, .95, 80);
}

// A gallery between two mirrors, with small lamps at its ceiling.
void drawGallery() {
  const RTid mirror = shaderOf("Mirror"), white = paint(.7f, .7f, .7f);
  rtPushMatrix();
  rtScaled(1, 1, 2);
  roomOf(paint(.4f, .4f, .45f), white, mirror, mirror, white);
  rtPopMatrix();
  for (int i = 0; i < 4; i++) lampAbove(.5 * (i % 2) - .25, .98, 1.2 - .8 * i, .03, 300);
  for (int i = 0; i < 3; i++)
    put(box(paint(.6f, .2f + .2f * float(i), .1f), .12, .4, .12), .5 * i - .5, -.6, -.6 * i,
        15. * i);
  eyeAt(.2, .1, 1.9, 60);
}

} // namespace

const std::vector<Scenario>& unseenScenes() {
  static const std::vector<Scenario> table = {
      {"blind", "a room behind the slats of a blind", RT_TRANSPORT_PATH, 64, 32768, 0, .1, "",
       drawBlind},
      {"projector", "an exact lens throws an image", RT_TRANSPORT_PATH, 64, 65536, 0, .1,
       "light is rare", drawProjector},
      {"lacquer", "smooth and rough coats, small lamps", RT_TRANSPORT_PATH, 64, 32768, 0, .1, "",
       drawLacquer},
      {"lampshade", "a bulb in a polished cone", RT_TRANSPORT_PATH, 64, 65536, 0, .1, "",
       drawLampshade},
      {"frosted", "a room lit through a frosted pane", RT_TRANSPORT_PATH, 64, 65536, 0, .1, "",
       drawFrosted},
      {"gallery", "small lamps between two mirrors", RT_TRANSPORT_PATH, 64, 65536, 0, .1, "",
       drawGallery},
  };
  return table;
}

} // namespace audit
