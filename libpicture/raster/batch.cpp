#include "libpicture/raster/batch.h"

#include <algorithm>

#include "parallel_for.h"

namespace picture::raster {

using Kind = xvrml::GeometryArrays::Kind;

namespace {

constexpr size_t mostPending = size_t(1) << 19; // bounds the memory of many small shapes
constexpr uint32_t partSize = 4096;
constexpr int bandRows = 16; // rows that one thread draws at a time

// Calls work(i) for i from 0 to before count, on several threads.
template <class Work> void forEach(size_t count, const Work& work) {
  parallelFor(tbb::blocked_range<size_t>(0, count), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) work(i);
  });
}

} // namespace

void Batch::add(xvrml::GeometryArrays arrays, const double matrix[16], Look look,
                std::vector<const Lamp*> lamps, Remarks& remarks) {
  Mesh& mesh = meshes_.emplace_back(std::move(arrays), matrix, std::move(look), remarks);
  mesh.lamps = std::move(lamps);
  mesh.number = shapes_++;
  const auto number = uint32_t(meshes_.size() - 1), count = uint32_t(mesh.size());
  for (uint32_t first = 0; first < count; first += partSize)
    parts_.push_back({number, first, std::min(count, first + partSize)});
  pending_ += count;
  if (pending_ >= mostPending) draw();
}

void Batch::draw() {
  project();
  forEach(parts_.size(), [&](size_t i) { find(parts_[i]); });
  const size_t bands = (size_t(frame_.height) + bandRows - 1) / bandRows;
  forEach(bands, [&](size_t band) {
    const int top = int(band) * bandRows, bottom = std::min(top + bandRows, frame_.height) - 1;
    for (const Part& part : parts_)
      if (part.top <= bottom && part.bottom >= top) fill(part, top, bottom);
    shade(top, bottom);
  });
  meshes_.clear();
  parts_.clear();
  pending_ = 0;
}

void Batch::project() {
  struct Range {
    Mesh* mesh;
    size_t first, last;
  };
  std::vector<Range> ranges;
  for (Mesh& mesh : meshes_) {
    const size_t count = mesh.vertices.local().size();
    mesh.corners.resize(count);
    for (size_t first = 0; first < count; first += partSize)
      ranges.push_back({&mesh, first, std::min(count, first + partSize)});
  }
  forEach(ranges.size(), [&](size_t i) {
    const Range& range = ranges[i];
    for (size_t v = range.first; v < range.last; ++v)
      range.mesh->corners[v] = eye_.project(range.mesh->vertices.place(v));
  });
}

void Batch::find(Part& part) const {
  const Mesh& mesh = meshes_[part.mesh];
  const int right = frame_.width - 1, bottom = frame_.height - 1;
  for (uint32_t place = part.first; place < part.last; ++place) {
    PixelBox box{0, right, 0, bottom};
    if (mesh.arrays.kind == Kind::triangles) {
      const std::array<uint32_t, 3> at = mesh.vertices.triangle(place);
      const Corner corners[3] = {mesh.corners[at[0]], mesh.corners[at[1]], mesh.corners[at[2]]};
      box = Triangle::box(corners, frame_.width, frame_.height);
      if (box.empty() || (mesh.arrays.solid && !Triangle::facesEye(corners))) continue;
    }
    part.top = part.found.empty() ? box.top : std::min(part.top, box.top);
    part.bottom = std::max(part.bottom, box.bottom);
    part.found.push_back({place, box});
  }
}

void Batch::fill(const Part& part, int top, int bottom) {
  const Mesh& mesh = meshes_[part.mesh];
  for (const Part::Found& found : part.found) {
    if (found.box.top > bottom || found.box.bottom < top) continue;
    if (mesh.arrays.kind == Kind::triangles)
      fillTriangle(part.mesh, found, top, bottom);
    else
      fillLine(mesh, found.place, top, bottom);
  }
}

void Batch::fillTriangle(uint32_t number, const Part::Found& found, int top, int bottom) {
  const Mesh& mesh = meshes_[number];
  const std::array<uint32_t, 3> at = mesh.vertices.triangle(found.place);
  const Corner corners[3] = {mesh.corners[at[0]], mesh.corners[at[1]], mesh.corners[at[2]]};
  const Triangle triangle(corners, eye_.nearest());
  const bool letsThrough = mesh.look.letsThrough();
  for (int y = std::max(top, found.box.top); y <= std::min(bottom, found.box.bottom); ++y)
    triangle.row(y, found.box.left, found.box.right, [&](int x, float depth) {
      const size_t pixel = frame_.place(x, y);
      if (!(depth > frame_.depth[pixel])) return;
      if (letsThrough && !shading_.coversPixel(mesh, found.place, x, y)) return;
      frame_.depth[pixel] = depth;
      frame_.visible[pixel] = {number, found.place};
    });
}

// Lines and points are one pixel wide. Those in the plane of a face lie on it.
void Batch::fillLine(const Mesh& mesh, uint32_t place, int top, int bottom) {
  const bool isLine = mesh.arrays.kind == Kind::lines;
  const size_t first = isLine ? size_t(place) * 2 : place, second = isLine ? first + 1 : first;
  const Corner ends[2] = {mesh.corners[mesh.index(first)], mesh.corners[mesh.index(second)]};
  const std::optional<Segment> segment = clipped(ends, eye_.nearest(), frame_.width, frame_.height);
  if (!segment) return;
  drawSegment(*segment, frame_.width, frame_.height, [&](int x, int y, float depth, double t) {
    if (y < top || y > bottom) return;
    const size_t pixel = frame_.place(x, y);
    const float towardsEye = depth + 1e-4f * std::abs(depth);
    if (towardsEye > frame_.depth[pixel])
      plot(pixel, towardsEye, shading_.colorOnLine(mesh, first, second, t));
  });
}

void Batch::plot(size_t pixel, float depth, const xvrml::Color& color) {
  frame_.depth[pixel] = depth;
  frame_.visible[pixel] = {};
  frame_.color[pixel] = color;
  frame_.covered[pixel] = 1;
}

void Batch::shade(int top, int bottom) {
  for (int y = top; y <= bottom; ++y)
    for (int x = 0; x < frame_.width; ++x) {
      const size_t pixel = frame_.place(x, y);
      const Frame::Visible seen = std::exchange(frame_.visible[pixel], {});
      if (seen.mesh == Frame::Visible::none) continue;
      frame_.color[pixel] = shading_.colorAt(meshes_[seen.mesh], seen.triangle, x + 0.5, y + 0.5);
      frame_.covered[pixel] = 1;
    }
}

} // namespace picture::raster
