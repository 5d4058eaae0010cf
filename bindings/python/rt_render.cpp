// rt_render.cpp: Implements Context.render() of xvrml.rt. A thread of its own renders the frame, so
// that the calling thread can check for Ctrl-C and report progress. [GIL held]
#include <chrono>
#include <condition_variable>

#include <pybind11/stl.h>

#include "objects.h"
#include "parameters.h"
#include "picture_object.h"
#include "quality_parameters.h"
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

// The arguments of Context.render(). The values are the defaults.
struct FrameArguments {
  std::pair<int, int> size{800, 600};
  std::optional<long long> spp;
  py::object channels = py::none();
  py::object progress = py::none();
  picture::QualityValues quality; // parameters that are quality settings (quality_parameters.h)
};

// Returns the bits of the channels; without a request rgba and depth, and with an error its
// channels.
uint32_t frameChannels(const FrameArguments& given) {
  if (!given.channels.is_none()) return RT_RGBA | channelsOf(given.channels);
  return RT_RGBA | RT_DEPTH | (given.quality[RT_TARGET_ERROR] > 0 ? RT_ERROR | RT_TRUST : 0);
}

// Returns the quality settings. Raises ValueError for a value that the library does not allow.
picture::QualityValues qualityOf(const FrameArguments& given) {
  picture::QualityValues quality = given.quality;
  const int most = quality[RT_TIME_LIMIT] > 0     ? 65536
                   : quality[RT_TARGET_ERROR] > 0 ? 4096
                                                  : quality.whole(RT_SAMPLES_PER_PIXEL);
  quality.set(RT_SAMPLES_PER_PIXEL, double(given.spp.value_or(most)));
  for (const RTqualityInfo& info : picture::qualityTable())
    checkQuality(info.quality, info.quality == RT_SAMPLES_PER_PIXEL ? "spp" : info.name,
                 quality[info.quality]);
  return quality;
}

py::object render(const RtContextPtr& self, const FrameArguments& given) {
  const uint32_t bits = frameChannels(given);
  const picture::QualityValues quality = qualityOf(given);
  const py::object bar = progressOf(given.progress);
  auto made = std::make_unique<PictureObject>();
  picture::Picture& picture = made->picture;
  const CurrentContext use(self);
  rtFrameBuffer(given.size.first, given.size.second, bits);
  picture::applyQuality(quality);
  use.check();
  const auto read = [&] {
    picture.width = given.size.first;
    picture.height = given.size.second;
    picture::fillChannels(picture, bits, [](uint32_t channel, std::vector<float>& plane) {
      rtReadPixels(channel, plane.data(), plane.size());
      return true;
    });
    RTstats s{};
    s.size = sizeof s;
    rtGetStats(&s);
    py::dict& stats = made->stats;
    stats["triangles"] = s.scene.triangles;
    stats["instances"] = s.scene.instances;
    stats["camera_rays"] = s.rays.camera;
    stats["shadow_rays"] = s.rays.shadow;
    stats["secondary_rays"] = s.rays.secondary;
    stats["build_seconds"] = s.time.commit + s.time.build;
    stats["render_seconds"] = s.time.render;
    stats["threads"] = s.machine.threads;
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
  defineMethod(
      context, "render", render,
      parameterList(parameter("size", &A::size), parameter("spp", &A::spp)),
      parameterList(
          qualityParameter<double>(RT_TARGET_ERROR), qualityParameter<double>(RT_TIME_LIMIT),
          qualityParameter<long long>(RT_MAX_DEPTH), qualityParameter<long long>(RT_SEED),
          qualityParameter<std::string>(RT_TRANSPORT), qualityParameter<Switch>(RT_SHADOWS),
          parameter("channels", &A::channels), parameter("progress", &A::progress),
          qualityParameter<Switch>(RT_FOLLOW_IMAGES), qualityParameter<Switch>(RT_JITTER),
          qualityParameter<long long>(RT_LIGHT_STRIDE),
          qualityParameter<std::string>(RT_DEPTH_ALONG)),
      "Renders the scene. Returns a Picture, like World.render. seed: 0 to 2147483647.");
}
