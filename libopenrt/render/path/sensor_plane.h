// sensor_plane.h: the plane that a grid of illuminance sensors fills (RT_MEASURE_ILLUMINANCE), and
// where light paths cross it. Each pixel has a cell: the parallelogram of the camera's rays through
// the pixel. A light path that crosses a cell brings its flux there; flux over area is the mean
// illuminance of the cell. Pure functions. [render]
#pragma once

#include <cstdint>
#include <optional>

#include "scene/vec3.h"

namespace openrt {

struct RenderScene;

class SensorPlane {
 public:
  // Returns the plane of the camera's rays: parallel rays that start in a plane across them.
  // Returns none if there is no camera, or if it has other rays, for example those of a perspective
  // view. Runs the camera's shader.
  static std::optional<SensorPlane> of(const RenderScene& scene);

  struct Crossing {
    uint32_t pixel;  // row by row
    double distance; // along the ray
  };
  // Returns where a ray comes through the grid from the side that the sensors face. direction:
  // unit.
  std::optional<Crossing> crossing(const Vec3f& origin, const Vec3f& direction) const;
  // Returns the area of a pixel's cell in render space.
  double cellArea() const { return cellArea_; }

 private:
  SensorPlane() = default;
  Vec3d corner_; // the upper left corner of the film
  Vec3d normal_; // unit; the side that light comes from
  // The scalar products with the difference from the corner are the column and the row.
  Vec3d toColumn_, toRow_;
  double cellArea_ = 0;
  uint32_t columns_ = 0, rows_ = 0;
};

} // namespace openrt
