// rt_render.cpp: Implements Context.render() of xvrml.rt. A thread of its own renders the frame, so
// that the calling thread can check for Ctrl-C and report progress. [GIL held]
#include <chrono>
#include <condition_variable>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "libpicture/transport.h"
#include "objects.h"
#include "picture_object.h"
#include "rt_objects.h"

namespace {

// Renders the frame; the callback may stop it early.
void renderWatched(RtContext& context, const picture::ProgressCallback& watch) {
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::thread thread([&] {
    rtMakeCurrent(context.handle);
    rtRender();
    rtMakeCurrent(nullptr);
    const std::scoped_lock lock(mutex);
    done = true;
    changed.notify_all();
  });
  bool stopped = false;
  std::unique_lock lock(mutex);
  while (!changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; })) {
    lock.unlock();
    stopped = stopped || watch(rtProgress(context.handle));
    // repeated: a cancellation before the frame has started would be lost
    if (stopped) rtCancel(context.handle);
    lock.lock();
  }
  lock.unlock();
  thread.join();
}

py::object render(const RtContextPtr& self, const std::pair<int, int>& size, std::optional<int> spp,
                  double error, double timeLimit, int depth, int seed, const std::string& transport,
                  bool shadows, const py::object& channels, const py::object& progress) {
  const std::optional<int> following = picture::transportNamed(transport);
  if (!following)
    throw py::value_error(
        fmt::format("transport: {} expected, not '{}'", picture::transportNames(), transport));
  uint32_t bits = uint32_t(
      RT_RGBA | (channels.is_none() ? RT_DEPTH | (error > 0 ? RT_ERROR | RT_TRUST : 0) : 0));
  if (!channels.is_none()) bits |= channelsOf(channels);
  const py::object bar = progressOf(progress);
  auto made = std::make_unique<PictureObject>();
  picture::Picture& picture = made->picture;
  const CurrentContext use(self);
  rtFrameBuffer(size.first, size.second, bits);
  rtQuality(RT_SAMPLES_PER_PIXEL, spp.value_or(timeLimit > 0 ? 65536 : error > 0 ? 4096 : 16));
  rtQualityf(RT_TARGET_ERROR, error);
  rtQualityf(RT_TIME_LIMIT, timeLimit);
  rtQuality(RT_MAX_DEPTH, depth);
  rtQuality(RT_SEED, seed);
  rtQuality(RT_TRANSPORT, *following);
  rtQuality(RT_SHADOWS, shadows);
  use.check();
  const auto read = [&] {
    picture.width = size.first;
    picture.height = size.second;
    for (const picture::Channel& channel : picture::channelTable()) {
      if (!(bits & channel.bit)) continue;
      std::vector<float>& plane = picture.planes[channel.bit];
      plane.resize(size_t(picture.width) * size_t(picture.height) * size_t(channel.components));
      rtReadPixels(channel.bit, plane.data(), plane.size());
    }
    RTstats s{};
    s.size = sizeof s;
    rtGetStats(&s);
    py::dict& stats = made->stats;
    stats["triangles"] = s.triangles;
    stats["instances"] = s.instances;
    stats["camera_rays"] = s.cameraRays;
    stats["shadow_rays"] = s.shadowRays;
    stats["secondary_rays"] = s.secondaryRays;
    stats["build_seconds"] = s.commitSeconds + s.buildSeconds;
    stats["render_seconds"] = s.renderSeconds;
    stats["threads"] = s.threads;
    describePicture(stats, s);
  };
  struct Drawing {
    RtContext& context;
    explicit Drawing(RtContext& c) : context(c) {
      context.owner = std::this_thread::get_id();
      context.drawing = true;
      rtMakeCurrent(nullptr); // the rendering thread makes it current
    }
    ~Drawing() {
      context.drawing = false;
      rtMakeCurrent(context.handle);
    }
  };
  const auto close = [&] {
    if (py::hasattr(bar, "close")) bar.attr("close")();
  };
  try {
    const Drawing drawing(*self);
    interruptible([&](picture::ProgressCallback watch) { renderWatched(*self, watch); }, bar);
  } catch (py::error_already_set& stopped) {
    close();
    read();
    rtGetError();
    stopped.value().attr("image") = py::cast(std::move(made)); // the finished part of the picture
    throw;
  }
  close();
  use.check();
  read();
  use.check();
  return py::cast(std::move(made));
}

} // namespace

void defineRtRender(py::class_<RtContext, RtContextPtr>& context) {
  context.def("render", render, py::arg("size") = std::pair<int, int>(800, 600),
              py::arg("spp") = py::none(), py::kw_only(), py::arg("error") = 0.0,
              py::arg("time_limit") = 0.0, py::arg("depth") = 25, py::arg("seed") = 0,
              py::arg("transport") = "auto", py::arg("shadows") = true,
              py::arg("channels") = py::none(), py::arg("progress") = py::none(),
              "A picture of the scene, as World.render makes one of a world.");
}
