// rt_render.cpp: Implements Context.render() of xvrml.rt. A thread of its own renders the frame, so
// that the calling thread can check for Ctrl-C and report progress. [GIL held]
#include <chrono>
#include <condition_variable>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "libpicture/transport.h"
#include "objects.h"
#include "parameters.h"
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

// The arguments of Context.render(), in the order of Python's signature. The values are the
// defaults.
struct FrameArguments {
  std::pair<int, int> size{800, 600};
  std::optional<int> spp;
  double error = 0;
  double timeLimit = 0;
  int depth = 25;
  int seed = 0;
  std::string transport = "auto";
  bool shadows = true;
  py::object channels = py::none();
  py::object progress = py::none();
};

// Returns the bits of the channels; without a request rgba and depth, and with an error its
// channels.
uint32_t frameChannels(const FrameArguments& given) {
  if (!given.channels.is_none()) return RT_RGBA | channelsOf(given.channels);
  return RT_RGBA | RT_DEPTH | (given.error > 0 ? RT_ERROR | RT_TRUST : 0);
}

// Sets the size and the quality of the next frame of the current context.
void setUpFrame(const FrameArguments& given, int transport, uint32_t channels) {
  rtFrameBuffer(given.size.first, given.size.second, channels);
  const int most = given.timeLimit > 0 ? 65536 : given.error > 0 ? 4096 : 16;
  rtQuality(RT_SAMPLES_PER_PIXEL, given.spp.value_or(most));
  rtQualityf(RT_TARGET_ERROR, given.error);
  rtQualityf(RT_TIME_LIMIT, given.timeLimit);
  rtQuality(RT_MAX_DEPTH, given.depth);
  rtQuality(RT_SEED, given.seed);
  rtQuality(RT_TRANSPORT, transport);
  rtQuality(RT_SHADOWS, given.shadows);
}

py::object render(const RtContextPtr& self, const FrameArguments& given) {
  const std::optional<int> transport = picture::transportNamed(given.transport);
  if (!transport)
    throw py::value_error(fmt::format("transport: {} expected, not '{}'", picture::transportNames(),
                                      given.transport));
  const uint32_t bits = frameChannels(given);
  const py::object bar = progressOf(given.progress);
  auto made = std::make_unique<PictureObject>();
  picture::Picture& picture = made->picture;
  const CurrentContext use(self);
  setUpFrame(given, *transport, bits);
  use.check();
  const auto read = [&] {
    picture.width = given.size.first;
    picture.height = given.size.second;
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
  using A = FrameArguments;
  defineMethod(context, "render", render,
               parameterList(parameter("size", &A::size), parameter("spp", &A::spp)),
               parameterList(parameter("error", &A::error), parameter("time_limit", &A::timeLimit),
                             parameter("depth", &A::depth), parameter("seed", &A::seed),
                             parameter("transport", &A::transport),
                             parameter("shadows", &A::shadows), parameter("channels", &A::channels),
                             parameter("progress", &A::progress)),
               "A picture of the scene, as World.render makes one of a world.");
}
