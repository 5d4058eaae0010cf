#include "libpicture/live/reconstruction.h"

#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "libpicture/live/stages.h"

namespace picture::live {

namespace {

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
  return {planeOf(frame, RT_RGBA, 4),     planeOf(frame, RT_DEPTH, 1),
          planeOf(frame, RT_NORMAL, 3),   planeOf(frame, RT_ALBEDO, 3),
          planeOf(frame, RT_POSITION, 3), planeOf(frame, RT_NAME, 1),
          planeOf(frame, RT_MOTION, 3),   planeOf(frame, RT_SAMPLES, 1)};
}

} // namespace

struct Reconstruction::Impl {
  explicit Impl(int threads) : arena(threads > 0 ? threads : tbb::task_arena::automatic) {}

  // Calls stage(y) for each row of the picture.
  template <class Stage> void rows(const Stage& stage) {
    constexpr int together = 4; // rows that are worth a task
    tbb::parallel_for(tbb::blocked_range<int>(0, now.layout.height, together),
                      [&](const tbb::blocked_range<int>& range) {
                        for (int y = range.begin(); y < range.end(); y++) stage(y);
                      });
  }

  void start(const FrameCamera& camera, int width, int height) {
    std::swap(now, before);
    if (const Layout layout(width, height); !(now.layout == layout)) now.resize(layout);
    if (!(workLayout == now.layout)) work.resize(workLayout = now.layout);
    now.projection = Projection(camera);
  }

  // Sums up changes of brightness over 31 x 31 pixels of the same surface. After the four passes
  // the result is in work.change, level and doubt.
  void findChanges() {
    ChangePass pass{{&work.change, &work.level, &work.doubt},
                    {&work.otherChange, &work.otherLevel, &work.otherDoubt},
                    1};
    for (; pass.step <= 8; pass.step *= 2) {
      rows([&](int y) { changeRow(pass, y, now); });
      std::swap(pass.from, pass.to);
    }
  }

  // Filters with neighbours farther and farther away; `result` is what the last pass wrote.
  void filter() {
    FilterPass pass{&now.accumulated.light, &work.variance, &work.filtered, &work.filteredVariance,
                    1};
    for (; pass.step <= 16; pass.step *= 2) {
      rows([&](int y) { filterRow(pass, y, now); });
      pass.from = pass.to;
      pass.variance = pass.toVariance;
      pass.to = pass.to == &work.filtered ? &work.light : &work.filtered;
      pass.toVariance = pass.toVariance == &work.variance ? &work.filteredVariance : &work.variance;
    }
    result = pass.from;
  }

  Picture add(const Picture& frame, const FrameCamera& camera) {
    const FramePlanes planes = planesOf(frame);
    start(camera, frame.width, frame.height);
    const bool rests = areEqual(now.projection.camera, before.projection.camera);
    rows([&](int y) { readRow(planes, before, rests, y, now, work); });
    rows([&](int y) { compareRow(y, now, work); });
    rows([&](int y) { estimateRow(y, now, work); });
    rows([&](int y) { recallRow(y, before, now, work); });
    findChanges();
    rows([&](int y) { accumulateRow(y, now, work); });
    rows([&](int y) { boundRow(y, now); });
    filter();
    rows([&](int y) { colourRow(*result, y, now, work); });

    Picture picture;
    picture.width = frame.width;
    picture.height = frame.height;
    picture.linear = frame.linear;
    picture.transparent = frame.transparent;
    std::vector<float>& rgba = picture.planes[RT_RGBA];
    rgba.resize(size_t(frame.width) * size_t(frame.height) * 4);
    rows([&](int y) {
      showRow(planes, y, before, now, work, rgba.data() + size_t(y) * size_t(frame.width) * 4);
    });
    const double pixels = double(frame.width) * frame.height;
    facts.reprojected = std::accumulate(work.found.begin(), work.found.end(), 0.0) / pixels;
    facts.history = std::accumulate(work.frames.begin(), work.frames.end(), 0.0) / pixels;
    return picture;
  }

  tbb::task_arena arena;
  Moment now, before;
  Work work;
  Layout workLayout;
  const Plane3* result = nullptr; // filtered illumination
  Facts facts;
};

Reconstruction::Reconstruction(int threads) : impl_(std::make_unique<Impl>(threads)) {}
Reconstruction::~Reconstruction() = default;

void Reconstruction::reset() {
  impl_->now = Moment();
  impl_->before = Moment();
}

Picture Reconstruction::add(const Picture& frame, const FrameCamera& camera) {
  const auto start = std::chrono::steady_clock::now();
  Picture picture = impl_->arena.execute([&] { return impl_->add(frame, camera); });
  impl_->facts.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return picture;
}

const Reconstruction::Facts& Reconstruction::facts() const { return impl_->facts; }

} // namespace picture::live
