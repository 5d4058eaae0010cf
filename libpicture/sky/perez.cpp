#include "libpicture/sky/perez.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>

namespace picture {

namespace {

// A class of skies by their clearness: coefficients of a to e of the distribution (1993, table 1),
// and of the luminous efficacies (1990, table 4).
struct Class {
  double below; // the clearness at which the next class begins
  double distribution[5][4];
  double direct[4], diffuse[4];
};
constexpr Class classes[] = {
    {1.065,
     {{1.3525, -.2576, -.2690, -1.4366},
      {-.7670, .0007, 1.2734, -.1233},
      {2.8, .6004, 1.2375, 1},
      {1.8734, .6297, .9738, .2809},
      {.0356, -.1246, -.5718, .9938}},
     {57.20, -4.55, -2.98, 117.12},
     {97.24, -.46, 12.00, -8.91}},
    {1.23,
     {{-1.2219, -.7730, 1.4148, 1.1016},
      {-.2054, .0367, -3.9128, .9156},
      {6.975, .1774, 6.4477, -.1239},
      {-1.5798, -.5081, -1.7812, .1080},
      {.2624, .0672, -.2190, -.4285}},
     {98.99, -3.46, -1.21, 12.38},
     {107.22, 1.15, .59, -3.95}},
    {1.5,
     {{-1.1, -.2515, .8952, .0156},
      {.2782, -.1812, -4.5, 1.1766},
      {24.7219, -13.0812, -37.7, 34.8438},
      {-5, 1.5218, 3.9229, -2.6204},
      {-.0156, .1597, .4199, -.5562}},
     {109.83, -4.90, -1.71, -8.81},
     {104.97, 2.96, -5.53, -8.77}},
    {1.95,
     {{-.5484, -.6654, -.2672, .7117},
      {.7234, -.6219, -5.6812, 2.6297},
      {33.3389, -18.3, -62.25, 52.0781},
      {-3.5, .0016, 1.1477, .1062},
      {.4659, -.3296, -.0876, -.0329}},
     {110.34, -5.84, -1.99, -4.56},
     {102.39, 5.59, -13.95, -13.90}},
    {2.8,
     {{-.6, -.3566, -2.5, 2.3250},
      {.2937, .0496, -5.6812, 1.8415},
      {21, -4.7656, -21.5906, 7.2492},
      {-3.5, -.1554, 1.4062, .3988},
      {.0032, .0766, -.0656, -.1294}},
     {106.36, -3.97, -1.75, -6.16},
     {100.71, 5.94, -22.75, -23.74}},
    {4.5,
     {{-1.0156, -.3670, 1.0078, 1.4051},
      {.2875, -.5328, -3.85, 3.375},
      {14, -.9999, -7.1406, 7.5469},
      {-3.4, -.1078, -1.0750, 1.5702},
      {-.0672, .4016, .3017, -.4844}},
     {107.19, -1.25, -1.51, -26.73},
     {106.42, 3.83, -36.15, -28.83}},
    {6.2,
     {{-1, .0211, .5025, -.5119},
      {-.3, .1922, .7023, -1.6317},
      {19, -5, 1.2438, -1.9094},
      {-4, .025, .3844, .2656},
      {1.0468, -.3788, -2.4517, 1.4656}},
     {105.75, .77, -1.26, -34.44},
     {141.88, 1.90, -53.24, -14.03}},
    {1e9,
     {{-1.05, .0289, .4260, .3590},
      {-.3250, .1156, .7781, .0025},
      {31.0625, -14.5, -46.1148, 55.375},
      {-7.2312, .4050, 13.35, .6234},
      {1.5, -.6426, 1.8564, .5636}},
     {101.18, 1.58, -1.10, -8.29},
     {152.23, .35, -45.27, -7.98}},
};

// Returns the extraterrestrial irradiance in W/m2: J. Spencer, "Fourier series representation of
// the position of the sun", 1971.
double extraterrestrial(int dayOfYear) {
  constexpr double solarConstant = 1367;
  if (dayOfYear == 0) return solarConstant;
  const double turn = 2 * std::numbers::pi * (dayOfYear - 1) / 365;
  return solarConstant * (1.00011 + .034221 * std::cos(turn) + .00128 * std::sin(turn) +
                          .000719 * std::cos(2 * turn) + .000077 * std::sin(2 * turn));
}

// Returns how much more air the light crosses than from the zenith: F. Kasten, 1965.
double airMass(double zenith) {
  const double degrees = std::min(zenith * 180 / std::numbers::pi, 90.0);
  return 1 / (std::cos(zenith) + .15 * std::pow(93.885 - degrees, -1.253));
}

// zenith: angle of the sun from it, in radians
SkyLuminance distributionOf(const Class& of, double zenith, double brightness) {
  const auto value = [&](int i) {
    const double(&x)[4] = of.distribution[i];
    return x[0] + x[1] * zenith + brightness * (x[2] + x[3] * zenith);
  };
  SkyLuminance sky{value(0), value(1), value(2), value(3), value(4)};
  if (&of != classes) return sky;
  const double(&c)[4] = of.distribution[2];
  const double(&d)[4] = of.distribution[3];
  sky.c = std::exp(std::pow(brightness * (c[0] + c[1] * zenith), c[2])) - c[3];
  sky.d = -std::exp(brightness * (d[0] + d[1] * zenith)) + d[2] + brightness * d[3];
  return sky;
}

} // namespace

PerezSky perezSky(const Irradiance& measured) {
  const double diffuse = measured.diffuseHorizontal,
               direct = measured.sunAltitude > 0 ? measured.directNormal : 0;
  if (!(diffuse > 0)) throw std::invalid_argument("there is no diffuse light of the sky");
  const double zenith = std::clamp(90 - measured.sunAltitude, 0.0, 90.0) * std::numbers::pi / 180;
  const double cube = 1.041 * zenith * zenith * zenith;
  const double clearness = ((diffuse + direct) / diffuse + cube) / (1 + cube);
  // The ranges are those of the data that the model was fitted to.
  double brightness =
      std::clamp(diffuse * airMass(zenith) / extraterrestrial(measured.dayOfYear), .01, .6);
  const Class& of = *std::find_if(std::begin(classes), std::end(classes) - 1,
                                  [&](const Class& one) { return clearness < one.below; });
  const double water = std::exp(.07 * measured.dewPoint - .075); // cm
  PerezSky sky;
  sky.diffuseHorizontal =
      diffuse * (of.diffuse[0] + of.diffuse[1] * water + of.diffuse[2] * std::cos(zenith) +
                 of.diffuse[3] * std::log(brightness));
  sky.directNormal = std::max(0.0, direct * (of.direct[0] + of.direct[1] * water +
                                             of.direct[2] * std::exp(5.73 * zenith - 5) +
                                             of.direct[3] * brightness));
  // Darker skies of these classes would get brighter without bound towards the horizon.
  if (clearness > 1.065 && clearness < 2.8) brightness = std::max(brightness, .2);
  sky.luminance = distributionOf(of, zenith, brightness);
  return sky;
}

} // namespace picture
