// batch.h: Draws meshes into a frame: projects their vertices, finds what is visible in each pixel,
// and then computes the colours of the pixels. All threads take part; the pixels do not depend on
// their number, because each row is drawn by one thread in the order of the meshes. [one thread]
#pragma once

#include <deque>

#include "libpicture/raster/fill.h"
#include "libpicture/raster/frame.h"
#include "libpicture/raster/mesh.h"
#include "libpicture/raster/shading.h"

namespace picture::raster {

class Batch {
 public:
  // All must outlive the object.
  Batch(const Eye& eye, const Shading& shading, Frame& frame)
      : eye_(eye), shading_(shading), frame_(frame) {}
  // Adds a mesh, and draws those so far if they are many.
  void add(xvrml::GeometryArrays arrays, const double matrix[16], Look look,
           std::vector<const Lamp*> lamps, Remarks& remarks);
  // Draws all meshes that are not drawn yet, and forgets them.
  void draw();

 private:
  // A piece of a mesh, and which of its triangles, lines or points may be seen.
  struct Part {
    uint32_t mesh, first, last; // from `first` to before `last`
    struct Found {
      uint32_t place;
      PixelBox box;
    };
    std::vector<Found> found = {};
    int top = 0, bottom = -1; // the rows of all of them
  };
  void project();
  void find(Part& part) const;
  void fill(const Part& part, int top, int bottom);
  void fillTriangle(uint32_t mesh, const Part::Found& found, int top, int bottom);
  void fillLine(const Mesh& mesh, uint32_t place, int top, int bottom);
  void plot(size_t pixel, float depth, const xvrml::Color& color);
  void shade(int top, int bottom);

  const Eye& eye_;
  const Shading& shading_;
  Frame& frame_;
  std::deque<Mesh> meshes_;
  std::vector<Part> parts_;
  size_t pending_ = 0;  // triangles, lines and points that are not drawn yet
  uint32_t shapes_ = 0; // number of meshes added
};

} // namespace picture::raster
