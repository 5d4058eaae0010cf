#include "libpicture/raster/raster.h"

#include <algorithm>
#include <deque>

#include <tbb/task_arena.h>

#include "libpicture/raster/batch.h"
#include "libpicture/raster/large_mesh.h"
#include "parallel_for.h"

namespace picture {

using xvrml::DrawnShape;
using xvrml::Node;
using xvrml::RenderState;
using xvrml::Visit;

namespace raster {
namespace {

// Finds what surrounds the shapes: lamps, and the bound nodes.
class Surroundings : public xvrml::Renderer {
 public:
  explicit Surroundings(const RasterView& view) : view_(view) {}
  Visit renderShape(xvrml::nodes::Shape&, const RenderState&) override { return Visit::skip; }
  Visit render(Node& node, const RenderState& state) override {
    if (lamps.size() < maximumLamps)
      if (std::optional<Lamp> lamp = Lamp::of(node, state, view_.linear))
        lamps.push_back(std::move(*lamp));
    const xvrml::BoundNodes bound = view_.bound.value_or(xvrml::BoundNodes());
    if (std::optional<Sky> found = Sky::of(node, state.matrix, view_.linear);
        found && !sky && isBound(node, bound.background, state))
      sky = std::move(found);
    if (const std::optional<Haze> found = Haze::of(node, view_.linear);
        found && !haze && isBound(node, bound.fog, state))
      haze = found;
    if (localHazes.size() < maximumLocalFogs)
      if (std::optional<Haze> found = Haze::local(node, state, view_.linear))
        localHazes.push_back(std::move(*found));
    const auto* navigation = xvrml::nodeCast<xvrml::nodes::NavigationInfo>(&node);
    if (navigation && !headlight && isBound(node, bound.navigationInfo, state))
      headlight = navigation->headlight;
    return Visit::children;
  }

  // Returns the fog in front of a shape: that of the nearest group, of several there the last one.
  const Haze* hazeBefore(const RenderState& shape) const {
    const Haze* nearest = haze ? &*haze : nullptr;
    size_t depth = 0;
    for (const Haze& local : localHazes) {
      if (local.depth() < depth || !local.reaches(shape)) continue;
      nearest = &local;
      depth = local.depth();
    }
    return nearest;
  }

  std::deque<Lamp> lamps; // meshes point to them
  std::deque<Haze> localHazes;
  std::optional<Sky> sky;
  std::optional<Haze> haze;
  std::optional<bool> headlight;

 private:
  // In a world that does not run, nodes within an Inline are not bound (clause 4.6.10).
  bool isBound(const Node& node, const Node* bound, const RenderState& state) const {
    if (view_.bound) return &node == bound;
    return std::none_of(state.path.begin(), state.path.end(),
                        [](const Node* above) { return xvrml::inlineScope(*above) != nullptr; });
  }

  const RasterView& view_;
};

// Puts the shapes into batches.
class Shapes : public xvrml::Renderer {
 public:
  Shapes(const xvrml::World& world, const RasterView& view, const Eye& eye,
         const Surroundings& around, Frame& frame)
      : view_(view), around_(around), textures_(world, view.linear),
        surfaces_(textures_, view.shaderPath, remarks_), shading_(eye, textures_),
        batch_(eye, shading_, frame) {}

  Visit renderShape(xvrml::nodes::Shape&, const RenderState&) override { return Visit::draw; }
  void draw(const DrawnShape& shape) override {
    xvrml::GeometryArrays arrays = arraysOf(shape);
    if (cornersOf(arrays.kind) == 0) return;
    Look look = lookOf(shape, arrays);
    if (!look.surface.visible) return;
    std::vector<const Lamp*> lamps;
    for (const Lamp& lamp : around_.lamps)
      if (lamp.reaches(shape.state)) lamps.push_back(&lamp);
    batch_.add(std::move(arrays), shape.matrix(), std::move(look), std::move(lamps), remarks_);
  }
  void finish() { batch_.draw(); }

 private:
  Look lookOf(const DrawnShape& shape, const xvrml::GeometryArrays& mesh) {
    const VertexColors colors = mesh.colors.empty()   ? VertexColors::none
                                : mesh.alphas.empty() ? VertexColors::opaque
                                                      : VertexColors::transparent;
    const bool isSurface = mesh.kind == xvrml::GeometryArrays::Kind::triangles;
    Look look;
    look.surface = surfaces_.make(shape.appearance(), colors, !isSurface);
    look.ambient =
        between0And1(xvrml::materialValues(shape.appearance().material).ambientIntensity);
    look.linear = view_.linear;
    look.haze = around_.hazeBefore(shape.state);
    Surface& surface = look.surface;
    // A clear body is drawn in a part of the pixels: what is behind it is seen, though not bent.
    if (surface.transmission > 0) {
      surface.opacity *= 1 - 0.75f * between0And1(surface.transmission);
      surface.alpha = Surface::Alpha::blend;
    }
    if (!view_.linear)
      for (xvrml::Color* color : {&surface.color, &surface.emission, &surface.specular})
        *color = codeOf(*color);
    return look;
  }

  const RasterView& view_;
  const Surroundings& around_;
  Remarks remarks_; // nobody is told: the mapper tells what is wrong with a world
  Textures textures_;
  Surfaces surfaces_;
  Shading shading_;
  Batch batch_;
};

// Adds the headlight, if the world has it. A world that would be dark gets a lamp at the eye, which
// shines on all that is seen.
void addHeadlight(const RasterView& view, const Eye& eye, Surroundings& around) {
  using Headlight = xvrml::MapOptions::Headlight;
  const bool wanted = view.headlight == Headlight::automatic ? around.headlight.value_or(true)
                                                             : view.headlight == Headlight::on;
  if (wanted)
    around.lamps.push_front(
        Lamp::along(eye.ray(view.width / 2.0, view.height / 2.0).direction,
                    around.headlight.has_value() || view.headlight == Headlight::on));
  else if (around.lamps.empty() && view.headlight == Headlight::automatic)
    around.lamps.push_front(Lamp::at(eye.position()));
}

std::vector<float> rgbaOf(const Frame& frame, const Eye& eye, const std::optional<Sky>& sky) {
  std::vector<float> rgba(frame.color.size() * 4);
  parallelFor(tbb::blocked_range<int>(0, frame.height), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y < rows.end(); ++y)
      for (int x = 0; x < frame.width; ++x) {
        const size_t place = frame.place(x, y);
        Sky::Seen seen{frame.color[place], float(frame.covered[place])};
        if (!frame.covered[place])
          seen = sky ? sky->along(eye.ray(x + 0.5, y + 0.5).direction) : Sky::Seen{};
        const float values[4] = {seen.color.r * seen.alpha, seen.color.g * seen.alpha,
                                 seen.color.b * seen.alpha, seen.alpha};
        std::copy_n(values, 4, rgba.begin() + ptrdiff_t(place * 4));
      }
  });
  return rgba;
}

} // namespace
} // namespace raster

std::vector<float> rasterize(const xvrml::World& world, const RasterView& view) {
  using namespace raster;
  const Eye eye(view.camera, view.toWorld, view.width, view.height);
  Frame frame(view.width, view.height);
  Surroundings around(view);
  tbb::task_arena arena(view.threads > 0 ? view.threads : tbb::task_arena::automatic);
  return arena.execute([&] {
    xvrml::RenderOptions options;
    options.view = view.camera.matrix;
    if (eye.isGood()) {
      xvrml::render(world, around, options);
      addHeadlight(view, eye, around);
      Shapes shapes(world, view, eye, around, frame);
      xvrml::render(world, shapes, options);
      shapes.finish();
    }
    if (!view.showsBackground) around.sky.reset();
    return rgbaOf(frame, eye, around.sky);
  });
}

} // namespace picture
