// frames.cpp: Implements the API functions for the frame buffer, quality settings, frames,
// statistics and ray queries. Runs on the application's thread.
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "api/guard.h"
#include "picture_size.h"
#include "scene/channels.h"
#include "scene/quality.h"
#include "scene/transports.h"

using namespace openrt;

namespace {

size_t componentsOf(RTenum channel) {
  const size_t components = channelComponents(channel);
  if (components == 0) fail(RT_INVALID_ENUM, "unknown channel " + std::to_string(channel));
  return components;
}

void setFrameBuffer(Context& c, int width, int height, uint32_t channels) {
  require(isPictureSize(width, height), RT_INVALID_VALUE,
          "a frame has 1 to 65536 pixels a side and at most 2^28 in all");
  require(channels != 0 && (channels & ~allChannels) == 0, RT_INVALID_VALUE,
          "the channels are 0 or contain an unknown one");
  c.scene.frame.width = static_cast<uint32_t>(width);
  c.scene.frame.height = static_cast<uint32_t>(height);
  c.scene.frame.channels = channels;
  c.scene.frameDirty = true;
}

void setScissor(Context& c, int x, int y, int width, int height) {
  constexpr int maxSide = 65536;
  require(x >= 0 && y >= 0 && x < maxSide && y < maxSide, RT_INVALID_VALUE,
          "a scissor begins at a pixel, 0 to 65535 each way");
  require((width == 0 && height == 0) ||
              (width >= 1 && height >= 1 && width <= maxSide && height <= maxSide),
          RT_INVALID_VALUE, "a scissor has 1 to 65536 pixels a side; 0 and 0 mean the whole frame");
  edit::FrameSettingsT& frame = c.scene.frame;
  frame.scissorX = static_cast<uint32_t>(x);
  frame.scissorY = static_cast<uint32_t>(y);
  frame.scissorWidth = static_cast<uint32_t>(width);
  frame.scissorHeight = static_cast<uint32_t>(height);
  c.scene.frameDirty = true;
}

void uniteNames(Context& c, const uint32_t* names, size_t count) {
  constexpr size_t most = size_t(1) << 24;
  require(names || count == 0, RT_INVALID_VALUE, "names is NULL, and count is not 0");
  require(count <= most, RT_INVALID_VALUE, "more than 2^24 names");
  std::vector<uint32_t> united;
  if (count > 0) united.assign(names, names + count);
  if (united == c.scene.frame.unitedNames) return;
  c.scene.frame.unitedNames = std::move(united);
  c.scene.frameDirty = true;
}

// real: the caller is rtQualityf.
void setQuality(Context& c, RTenum name, double value, bool real) {
  const QualitySetting* setting = findQuality(name);
  if (!setting || (setting->info.isReal != 0) != real)
    fail(RT_INVALID_ENUM, "unknown quality " + std::to_string(name));
  if (!setting->allows(value)) fail(RT_INVALID_VALUE, qualityFault(setting->info, value));
  if (!setting->set) { // affects how frames are started
    if (name == RT_FRAMES_IN_FLIGHT) c.framesInFlight = static_cast<uint32_t>(value);
    if (name == RT_PATIENCE) c.patience = value;
    return;
  }
  // Frames hold 32 bits. A positive number stays one: 0 means none, or no limit.
  const double least = real && value > 0 ? double(std::numeric_limits<float>::min()) : value;
  setting->set(c.scene.frame, std::max(value, least));
  c.scene.frameDirty = true;
}

void readPixels(Context& c, RTenum channel, float* out, size_t count) {
  const size_t components = componentsOf(channel);
  const edit::FrameSettingsT& frame = c.finishedFrame();
  require((frame.channels & channel) != 0, RT_INVALID_OPERATION,
          "the frame was rendered without this channel");
  const size_t needed = components * frame.width * frame.height;
  require(out != nullptr, RT_INVALID_VALUE, "the pointer is NULL");
  if (count < needed)
    fail(RT_INVALID_VALUE, "the array has room for " + std::to_string(count) +
                               " floats; the channel has " + std::to_string(needed));
  require(c.backend().read(channel, {out, needed}), RT_INVALID_OPERATION,
          "the backend has no such channel");
}

void getStats(Context& c, RTstats* out) {
  require(out != nullptr, RT_INVALID_VALUE, "the pointer is NULL");
  const size_t size = out->size;
  require(size >= sizeof(size_t), RT_INVALID_VALUE, "set size to sizeof(RTstats) before the call");
  RTstats stats{};
  stats.size = sizeof(stats);
  c.backend().stats(stats);
  stats.scene.objects = c.scene.objects.entries.size();
  stats.scene.instances = c.scene.instances.entries.size();
  stats.scene.lights = c.scene.lights.entries.size();
  stats.scene.textures = c.scene.textures.entries.size();
  stats.rejected.primitives += c.degenerate;
  stats.frame = c.finishedFrameNumber();
  stats.size = size; // the structure of an older program is shorter
  std::memcpy(out, &stats, std::min(size, sizeof(stats)));
}

// Copies a description into the caller's structure. Returns 1, or 0 if that is null or its size is
// not set.
template <class Info> int copyInfo(const Info& known, Info* info) {
  if (!info || info->size < sizeof(size_t)) return 0;
  const size_t size = info->size; // an older program's structure ends earlier
  std::memcpy(info, &known, std::min(size, sizeof(known)));
  info->size = size;
  return 1;
}

void requireNoDefinition(Context& c) {
  c.requireOutsideDefinition(); // no commit while an object is only partly defined
}

} // namespace

void rtFrameBuffer(int width, int height, uint32_t channels) {
  guarded("rtFrameBuffer", [&](Context& c) { setFrameBuffer(c, width, height, channels); });
}

void rtUniteNames(const uint32_t* names, size_t count) {
  guarded("rtUniteNames", [&](Context& c) { uniteNames(c, names, count); });
}

void rtScissor(int x, int y, int width, int height) {
  guarded("rtScissor", [&](Context& c) { setScissor(c, x, y, width, height); });
}

void rtQuality(RTenum name, int value) {
  guarded("rtQuality", [&](Context& c) { setQuality(c, name, value, false); });
}

void rtQualityf(RTenum name, double value) {
  guarded("rtQualityf", [&](Context& c) { setQuality(c, name, value, true); });
}

int rtGetQualityInfo(int number, RTqualityInfo* info) {
  const auto settings = qualitySettings();
  if (number < 0 || size_t(number) >= settings.size()) return 0;
  return copyInfo(settings[size_t(number)].info, info);
}

int rtIsQualityAllowed(RTenum quality, double value) {
  const QualitySetting* setting = findQuality(quality);
  return setting && setting->allows(value) ? 1 : 0;
}

int rtGetTransportInfo(RTenum transport, RTtransportInfo* info) {
  if (!isTransport(transport)) return 0;
  const TransportTraits& row = transports[transport];
  const RTtransportInfo known{sizeof known, row.transport,   row.name,        row.text,
                              row.claim,    row.tracesPaths, row.tracesLamps, row.omits};
  return copyInfo(known, info);
}

int rtGetChannelInfo(int number, RTchannelInfo* info) {
  if (number < 0 || size_t(number) >= channelTable.size()) return 0;
  const ChannelInfo& row = channelTable[size_t(number)];
  const RTchannelInfo known{sizeof known, row.bit,  row.name, int(row.components),
                            row.planes,   row.kind, row.text};
  return copyInfo(known, info);
}

void rtSwapBuffers(void) {
  guarded("rtSwapBuffers", [](Context& c) {
    requireNoDefinition(c);
    c.swapBuffers();
  });
}

int rtFinishFrame(void) {
  return guarded("rtFinishFrame", 0, [](Context& c) { return c.finishFrame() ? 1 : 0; });
}

void rtRender(void) {
  guarded("rtRender", [](Context& c) {
    requireNoDefinition(c);
    c.render();
  });
}

void rtReadPixels(RTenum channel, float* out, size_t count) {
  guarded("rtReadPixels", [&](Context& c) { readPixels(c, channel, out, count); });
}

void rtGetStats(RTstats* stats) {
  guarded("rtGetStats", [&](Context& c) { getStats(c, stats); });
}
