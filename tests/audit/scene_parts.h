// scene_parts.h: building blocks of the audit's scenes. They call the public C API in the current
// context, under the current matrix. [one thread]
#pragma once

#include "openrt/openrt.h"

namespace audit {

RTid diffuse(float emission, float reflectance);
RTid paint(float r, float g, float b); // diffuse shader
RTid shaderOf(const char* shaderClass);
void colored(RTid shader, const char* parameter, float r, float g, float b);
void set(RTid shader, const char* parameter, float value);

void square(RTid shader, double half); // in z = 0, faces +z
RTid box(RTid shader, double x, double y, double z);
RTid ball(RTid shader, float radius);
void put(RTid object, double x, double y, double z, double turn);          // turn: degrees about +y
void lampAbove(double x, double y, double z, double half, float radiance); // faces -y
void floorAt(double y, RTid shader, double half);                          // faces +y
// A box of half-width 1 about the origin, open towards +z.
void roomOf(RTid floor, RTid ceiling, RTid left, RTid right, RTid back);
void sky(int colors, const float* color, const float* angle, double tilt,
         float turnOfAxis); // tilt: degrees about (1, 0, turnOfAxis)

// the camera looks from far above at a square of this height about the origin
void lookDown(double height);
void eyeAt(double x, double y, double z, double degrees);
// A camera with a thin lens, focused at a distance.
void lensAt(double x, double y, double z, double degrees, float radius, float focus);

double randomNumber(unsigned number,
                    unsigned which); // random number in [0, 1), the same in every run

} // namespace audit
