#include "libpicture/live/reconstruction.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include <tbb/task_arena.h>

#include "libpicture/live/denoise.h"
#include "libpicture/live/stages.h"
#include "parallel_for.h"

namespace picture::live {

namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Returns a plane of a frame, after checking that each pixel has its numbers.
const float* planeOf(const Picture& frame, uint32_t channel, size_t numbers) {
  const auto found = frame.planes.find(channel);
  if (found == frame.planes.end())
    throw std::invalid_argument("a preview needs channel " + std::to_string(channel) +
                                " of its frame");
  if (found->second.size() != size_t(frame.width) * size_t(frame.height) * numbers)
    throw std::invalid_argument("channel " + std::to_string(channel) +
                                " of a frame has another size than the frame");
  return found->second.data();
}

FramePlanes planesOf(const Picture& frame) {
  // as rtFrameBuffer allows
  if (frame.width < 1 || frame.height < 1 || frame.width > 65536 || frame.height > 65536)
    throw std::invalid_argument("a preview needs a frame of 1 to 65536 pixels each way, not " +
                                std::to_string(frame.width) + " x " + std::to_string(frame.height));
  return {planeOf(frame, RT_RGBA, 4),
          planeOf(frame, RT_DEPTH, 1),
          planeOf(frame, RT_NORMAL, 3),
          planeOf(frame, RT_ALBEDO, 3),
          planeOf(frame, RT_POSITION, 3),
          planeOf(frame, RT_NAME, 1),
          planeOf(frame, RT_MOTION, 3),
          planeOf(frame, RT_SAMPLES, 1),
          planeOf(frame, RT_REFLECTION, 3),
          planeOf(frame, RT_PLACE, 2),
          frame.planes.count(RT_VARIANCE) ? planeOf(frame, RT_VARIANCE, 3) : nullptr};
}

} // namespace

struct Reconstruction::Impl {
  explicit Impl(int threads) : arena(threads > 0 ? threads : tbb::task_arena::automatic) {}

  // Calls stage(y) for each row of pixels or cells.
  template <class Stage> void rows(const Moment& grid, const Stage& stage) {
    rows(grid.layout, stage);
  }
  template <class Stage> void rows(const Layout& layout, const Stage& stage) {
    constexpr int together = 4; // rows that are worth a task
    parallelFor(tbb::blocked_range<int>(0, layout.height, together),
                [&](const tbb::blocked_range<int>& range) {
                  for (int y = range.begin(); y < range.end(); y++) stage(y);
                });
  }

  // Prepares the planes of a frame. `now` and `reading` are those of cells.
  void start(const FrameCamera& camera, const Layout& picture, int block) {
    std::swap(now, before);
    std::swap(pixels, pixelsBefore);
    std::swap(shownLight, shownLightBefore);
    std::swap(coats.now, coats.before);
    const Layout cells((picture.width + block - 1) / block, (picture.height + block - 1) / block);
    now.block = block;
    now.projection = Projection(camera);
    if (!(now.layout == cells)) now.resize(cells);
    if (!(workLayout == cells)) {
      work.resize(cells);
      reading.resize(cells);
      coats.work.resize(cells);
      workLayout = cells;
    }
    if (coats.now.light.x.size() != now.layout.size()) coats.now.resize(now.layout);
    if (!(shownLight.layout == picture)) shownLight.resize(picture);
    if (!(freshLayout == picture)) {
      fresh.resize(freshLayout = picture);
      bounds.resize(picture);
    }
    // Pixels and cells are the same planes if all cells are pixels, in the frame before, too.
    sparse = block > 1 || before.block > 1;
    if (!sparse) return;
    pixels.projection = now.projection;
    if (!(pixels.layout == picture)) pixels.resize(picture, false);
    if (!(pixelLayout == picture)) pixelReading.resize(pixelLayout = picture);
  }

  // Prepares the planes of the picture that is shown of a frame.
  void startShowing(const Layout& picture, ShownSize size) {
    const int width = std::max(picture.width, size.width),
              height = std::max(picture.height, size.height);
    std::swap(shown, shownBefore);
    if (const Layout wanted(width, height); !(shown.layout == wanted)) shown.resize(wanted);
    if (columns.frame != picture.width || columns.picture != width)
      columns = Overlaps(picture.width, width);
    if (rowsOfFrame.frame != picture.height || rowsOfFrame.picture != height)
      rowsOfFrame = Overlaps(picture.height, height);
  }

  // Notes whether the samples in the pixels tell their noise. Those of cells do not.
  void findVariance(FramePlanes& planes) {
    if (sparse) planes.variance = nullptr;
    if (!planes.variance && hasVariance)
      for (Plane* plane : {&reading.variance, &reading.reflectionVariance})
        std::fill(plane->begin(), plane->end(), Reading::unknown);
    hasVariance = planes.variance != nullptr;
  }

  // The surfaces of the frame before, by pixel.
  Moment& pixelsOfBefore() { return before.block > 1 ? pixelsBefore : before; }

  void read(const FramePlanes& planes) {
    const Moment& old = pixelsOfBefore();
    const ReadPass pass{
        planes,        old,          areEqual(now.projection.camera, before.projection.camera),
        now.block > 1, shown.layout, isFirst};
    if (!sparse) {
      rows(now, [&](int y) { readRow(pass, y, now, reading); });
      return;
    }
    rows(pixels, [&](int y) { readRow(pass, y, pixels, pixelReading); });
    const CellPass cells{planes, pixels, old, pixelReading, before, shownLightBefore};
    rows(now, [&](int y) { cellRow(cells, y, now, reading, work); });
  }

  // Rebuilds the illumination of the frame by cell; `result` is where it lies.
  void rebuild() {
    rows(now, [&](int y) { compareRow(reading, y, now, work); });
    rows(now, [&](int y) { estimateRow(reading, y, now, work); });
    rows(now, [&](int y) { recallRow(reading, y, before, now, work); });
    findChanges();
    rows(now, [&](int y) { accumulateRow(reading, y, now, work); });
    rows(now, [&](int y) { boundRow(y, now); });
    filter();
  }

  // Exchanges illumination and what coats reflect, so that the stages work on the other one.
  void exchange() {
    std::swap(now.accumulated, coats.now);
    std::swap(before.accumulated, coats.before);
    std::swap(reading.light, reading.reflection);
    std::swap(reading.variance, reading.reflectionVariance);
    std::swap(work, coats.work);
  }

  // Rebuilds what coats reflect. It is accumulated and filtered as illumination is, but apart from
  // it, since it has not the colour of the surface.
  void rebuildReflections() {
    const auto isSome = [](const Plane& plane) {
      return std::any_of(plane.begin(), plane.end(), [](float v) { return v != 0; });
    };
    const bool some = isSome(reading.reflection.x);
    if (!some && !coats.some) return;
    if (!coats.some) coats.before.resize(before.layout);
    coats.some = some;
    exchange();
    rebuild();
    exchange();
    coats.result = result == &work.filtered ? &coats.work.filtered : &reading.reflection;
  }

  // Sums up changes of brightness over 31 x 31 pixels of the same surface. After the four passes
  // the result is in work.change, level and doubt.
  void findChanges() {
    ChangePass pass{{&work.change, &work.level, &work.doubt},
                    {&work.otherChange, &work.otherLevel, &work.otherDoubt},
                    1};
    for (; pass.step <= 8; pass.step *= 2) {
      rows(now, [&](int y) { changeRow(pass, y, now); });
      std::swap(pass.from, pass.to);
    }
  }

  double meanHistory() const {
    const double cells = double(now.layout.width) * now.layout.height;
    return std::accumulate(work.frames.begin(), work.frames.end(), 0.0) / cells;
  }

  // Filters with neighbours farther and farther away; `result` is what the last pass wrote. The
  // last pass reaches as far in pixels whatever the size of cells, but after a jump, when there are
  // few samples, as many cells.
  void filter() {
    constexpr int reach = 16;
    constexpr double fewFrames = 4;
    const int farthest = meanHistory() < fewFrames ? reach : reach / now.block;
    FilterPass pass{&now.accumulated.light,
                    &work.variance,
                    &work.filtered,
                    &work.filteredVariance,
                    1,
                    perPixel};
    for (; pass.step <= farthest; pass.step *= 2) {
      rows(now, [&](int y) { filterRow(pass, y, now); });
      pass.from = pass.to;
      pass.variance = pass.toVariance;
      pass.to = pass.to == &work.filtered ? &reading.light : &work.filtered;
      pass.toVariance = pass.toVariance == &work.variance ? &work.filteredVariance : &work.variance;
    }
    result = pass.from;
  }

  // Tells whether there is anything that a denoiser may change.
  bool isNoisy() const {
    const Plane& noise = now.accumulated.noise;
    return std::any_of(noise.begin(), noise.end(), [](float n) { return n > 0; });
  }

  // Lets a denoiser filter the illumination, too, and mixes what it makes of it into `result`.
  // Returns whether it has succeeded.
  bool denoise(OidnFilter& denoiser) {
    const auto begin = Clock::now();
    try {
      images.resize(now.layout.width, now.layout.height);
      rows(now, [&](int y) { imageRow(now, reading, y, images); });
      denoiser.denoise(images);
    } catch (const OidnError& error) {
      facts.problem = error.what();
      return false;
    }
    rows(now, [&](int y) { lightRow(now, reading, images, y, *result, work.filtered); });
    result = &work.filtered;
    facts.denoising = secondsSince(begin);
    return true;
  }

  // Writes `fresh` from the filtered illumination.
  void colour(const FramePlanes& planes) {
    const Moment& grid = sparse ? pixels : now;
    const ColourPass pass{planes,
                          grid,
                          pixelsOfBefore(),
                          sparse ? pixelReading : reading,
                          now,
                          reading.albedo,
                          *result,
                          coats.result,
                          work.verdict,
                          shownLightBefore,
                          shownBefore,
                          shown.layout};
    rows(grid,
         [&](int y) { now.block > 1 ? spreadRow(pass, y, fresh) : colourRow(pass, y, fresh); });
  }

  // Returns the picture after this frame, in its own size.
  Picture show(const Picture& frame, const FramePlanes& planes) {
    const auto begin = Clock::now();
    const Moment& grid = sparse ? pixels : now;
    rows(grid, [&](int y) { boundColourRow(grid.layout, y, fresh, bounds, shownLight); });
    Picture picture = withChannels(frame, 0);
    picture.width = shown.layout.width;
    picture.height = shown.layout.height;
    const size_t numbers = 4 * size_t(picture.width);
    std::vector<float>& rgba = picture.planes[RT_RGBA];
    rgba.resize(numbers * size_t(picture.height));
    const ShowPass pass{planes,      grid,        sparse ? pixelReading : reading,
                        fresh,       bounds,      columns,
                        rowsOfFrame, shownBefore, perPixel};
    rows(shown.layout, [&](int y) { showRow(pass, y, shown, rgba.data() + size_t(y) * numbers); });
    facts.showing = secondsSince(begin);
    return picture;
  }

  Picture add(const Picture& frame, const FrameCamera& camera, int lightStride,
              OidnFilter* denoiser, ShownSize size) {
    facts = {};
    FramePlanes planes = planesOf(frame);
    const Layout layout(frame.width, frame.height);
    start(camera, layout, lightStride);
    findVariance(planes);
    const size_t count = size_t(frame.width) * size_t(frame.height);
    perPixel = std::max(1.0f, *std::max_element(planes.samples, planes.samples + count));
    startShowing(layout, size);
    read(planes);
    names.markGone(pixelsOfBefore(), sparse ? pixels : now, shownBefore);
    coats.result = nullptr;
    rebuildReflections();
    rebuild();
    facts.denoised = denoiser && isNoisy() && denoise(*denoiser);
    colour(planes);

    Picture picture = show(frame, planes);
    const double cells = double(now.layout.width) * now.layout.height;
    facts.reprojected = std::accumulate(work.found.begin(), work.found.end(), 0.0) / cells;
    facts.history = meanHistory();
    isFirst = false;
    return picture;
  }

  tbb::task_arena arena;
  bool isFirst = true; // no frame has been added since reset()
  Moment now, before;  // by cell
  Reading reading;
  bool hasVariance = false; // `reading` has variances
  float perPixel = 1;       // samples in a pixel of the frame, 1 or more
  Work work;
  Layout workLayout;
  // These are for what coats reflect: `accumulated` of `now` and `before`, and the working storage.
  struct {
    Accumulated now, before;
    Work work;
    bool some = false;              // `now` has some, or the frame before had
    const Plane3* result = nullptr; // filtered; null: there is none
  } coats;
  bool sparse = false;         // the planes of pixels are not those of cells
  Moment pixels, pixelsBefore; // surfaces; used only if `sparse`
  Reading pixelReading;
  Layout pixelLayout;
  NamesSeen names;
  Fresh fresh;
  Layout freshLayout;
  Bounds bounds;
  ShownLight shownLight, shownLightBefore;
  Shown shown, shownBefore;
  Overlaps columns, rowsOfFrame;  // how the pixels of `shown` lie in the frame
  const Plane3* result = nullptr; // filtered illumination
  OidnImages images;
  Facts facts;
};

Reconstruction::Reconstruction(int threads) : impl_(std::make_unique<Impl>(threads)) {}
Reconstruction::~Reconstruction() = default;

void Reconstruction::reset() {
  impl_->now = Moment();
  impl_->before = Moment();
  impl_->shownLight = ShownLight();
  impl_->shown = Shown();
  impl_->coats.some = false;
  impl_->isFirst = true;
}

Picture Reconstruction::add(const Picture& frame, const FrameCamera& camera, int lightStride,
                            OidnFilter* denoiser, ShownSize shown) {
  if (lightStride < 1 || lightStride > mostLightStride)
    throw std::invalid_argument("a preview cannot have light in one of " +
                                std::to_string(lightStride) + " pixels each way");
  if (shown.width > 65536 || shown.height > 65536)
    throw std::invalid_argument("a preview has at most 65536 pixels each way, not " +
                                std::to_string(shown.width) + " x " + std::to_string(shown.height));
  const Clock::time_point begin = Clock::now();
  Picture picture =
      impl_->arena.execute([&] { return impl_->add(frame, camera, lightStride, denoiser, shown); });
  impl_->facts.seconds = secondsSince(begin);
  return picture;
}

const Reconstruction::Facts& Reconstruction::facts() const { return impl_->facts; }

} // namespace picture::live
