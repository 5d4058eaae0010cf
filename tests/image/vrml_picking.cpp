// vrml_picking.cpp: a pointer ray hits what is drawn: Browser::pick compared with pictures of the
// ray tracer.
#include <cmath>

#include "image/vrml_scene.h"
#include "xvrml/browser.h"

namespace xvrml::test {
namespace {

// Every geometry with a surface: rotated, stretched, culled, in an LOD, in a Billboard.
const std::string everything = R"(
Viewpoint { position 0 3 16 orientation 1 0 0 -0.15 }
Transform { translation -6 3 0 rotation 1 1 0 0.7 children Shape { geometry Box { size 2 1 3 } } }
Transform { translation -3 3 0 scale 1 2 1 children Shape { geometry Sphere {} } }
Transform { translation 0 3 0 rotation 0 0 1 0.5 scale 1 1 2 scaleOrientation 0 1 1 1
  children Shape { geometry Cylinder { top FALSE } } }
Transform { translation 3 3 0 rotation 1 0 0 0.8 children Shape { geometry Cone { bottom FALSE } } }
Transform { translation 5 3 0 children Shape { geometry ElevationGrid { xDimension 3 zDimension 3 solid FALSE
  height [ 0 1 0 1 2 0 0 0.5 1 ] } } }
Transform { translation -6 0 0 children Shape { geometry Extrusion { convex FALSE spine [ 0 -1 0, 0 0 0.3, 0.5 1 0 ] } } }
Transform { translation -3 0 0 children Shape { geometry Text { string "Ray" fontStyle FontStyle { size 1.5 } } } }
Transform { translation 1 0 0 rotation 0 1 0 0.4 children Shape { geometry IndexedFaceSet { convex FALSE solid FALSE
  coord Coordinate { point [ 0 0 0, 2 0 0, 0.5 0.5 0, 0 2 0 ] } coordIndex [ 0 1 2 3 ] } } }
Transform { translation 3 0 0 children Shape { geometry IndexedFaceSet { ccw FALSE
  coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 -1 0 2 1 ] } } }
Transform { translation 5 -1 0 rotation 0 1 0 2 children Billboard { children Shape { geometry Box { size 1 1 0.1 } } } }
Transform { translation 6 1 0 children LOD { range [ 5 ] level [
  Shape { geometry Box {} } Shape { geometry Sphere { radius 0.7 } } ] } }
Switch { whichChoice 1 choice [ Transform { translation 0 0 5 children Shape { geometry Box {} } }
  Transform { translation -1 -2 0 children [ DEF S Shape { geometry Box {} }
    Transform { translation 3 0 0 scale 0.5 1 1 children USE S } ] } ] }
Collision { proxy Shape { geometry Box { size 9 9 9 } } }
)";

TEST(Picking, MeetsWhatIsDrawn) {
  SceneOptions options;
  options.width = 96;
  options.height = 72;
  options.channels = RT_RGBA | RT_DEPTH | RT_POSITION;
  Scene scene(everything, options);
  Browser browser(loadWorldFromMemory("#VRML V2.0 utf8\n" + everything, "scene.wrl"));
  const CameraSettings camera = browser.camera(4.0 / 3);
  scene.render(camera);
  const std::vector<float> depth = scene.channel(RT_DEPTH, 1),
                           place = scene.channel(RT_POSITION, 3);
  int drawn = 0, differ = 0, invented = 0;
  for (size_t p = 0; p < depth.size(); ++p) {
    PickHit hit;
    double direction[3];
    if (std::isfinite(depth[p])) {
      ++drawn;
      for (size_t k = 0; k < 3; ++k)
        direction[k] = double(place[3 * p + k]) - camera.matrix[12 + k];
      const bool meets = browser.pick(camera.matrix + 12, direction, {}, hit);
      differ += !meets || std::abs(hit.distance - 1) > 1e-4;
      continue;
    }
    // Rows start at the top. The sample position in the pixel is unknown, so pixels at edges are
    // skipped.
    const int x = int(p) % options.width, y = int(p) / options.width;
    bool edge = x == 0 || y == 0 || x == options.width - 1 || y == options.height - 1;
    for (int dy = -1; dy <= 1 && !edge; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        edge |= std::isfinite(depth[p + size_t(dy * options.width + dx)]);
    if (edge) continue;
    const double size = std::tan(camera.fovy / 2);
    const double u = ((x + 0.5) / options.width * 2 - 1) * size * 4 / 3,
                 v = (1 - (y + 0.5) / options.height * 2) * size;
    for (int k = 0; k < 3; ++k)
      direction[k] = camera.matrix[k] * u + camera.matrix[4 + k] * v - camera.matrix[8 + k];
    invented += browser.pick(camera.matrix + 12, direction, {}, hit);
  }
  EXPECT_GT(drawn, 1000);
  EXPECT_LE(differ, drawn / 200); // on outlines, because positions are floats
  EXPECT_EQ(invented, 0);
}

} // namespace
} // namespace xvrml::test
