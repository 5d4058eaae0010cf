// sums.cpp: Implements the API functions for kept sums (openrt/sums.h). The only file of the API
// that knows how frames are rendered, because sums are used without a context.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "api/guard.h"
#include "openrt/sums.h"
#include "render/frame/frame_sums.h"
#include "scene/channels.h"

struct RTsumsObject {
  std::shared_ptr<const openrt::FrameSums> sums;
  std::mutex mutex;                                 // guards picture
  std::unique_ptr<const openrt::FrameWork> picture; // made by the first call that needs it
};

using namespace openrt;

namespace {

// Runs body() without a context. Records exceptions as errors of the thread.
template <class Result, class Body>
Result guardedHere(const char* function, Result failure, Body&& body) noexcept {
  try {
    return body();
  } catch (...) {
    Context* const context = currentContext;
    recordCurrentException(context && context->open() ? context->errors : threadErrors(), function);
  }
  return failure;
}

RTsums newSums(std::shared_ptr<const FrameSums> sums) {
  auto made = std::make_unique<RTsumsObject>();
  made->sums = std::move(sums);
  return made.release();
}

void requireSums(RTsums sums) { require(sums != nullptr, RT_INVALID_VALUE, "the sums are NULL"); }

const FrameWork& pictureOf(RTsums sums) {
  requireSums(sums);
  const std::lock_guard lock(sums->mutex);
  if (!sums->picture) sums->picture = std::make_unique<FrameWork>(*condense(*sums->sums));
  return *sums->picture;
}

// Returns which share of the samples of a picture is there.
double doneOf(const FrameSums& sums) {
  if (sums.complete) return 1;
  double done = 0, all = 0;
  for (const SeedSums& seeds : sums.seeds)
    for (const std::vector<KeptBlock>& blocks : seeds.tiles) {
      all += sums.frame.samples;
      for (const KeptBlock& block : blocks)
        if (block.replicates.seed == sums.frame.seed) done += block.count;
    }
  return all > 0 ? std::min(done / all, 1.0) : 0;
}

RTsumsInfo infoOf(const FrameSums& sums) {
  RTsumsInfo info{};
  info.width = int(sums.frame.width);
  info.height = int(sums.frame.height);
  info.channels = sums.frame.channels;
  info.samples = sums.frame.samples;
  for (const SeedSums& seeds : sums.seeds) info.seeds += seeds.count;
  info.firstSeed = sums.seeds.front().first;
  info.lastSeed = sums.seeds.back().first + sums.seeds.back().count - 1;
  info.complete = sums.complete ? 1 : 0;
  info.done = doneOf(sums);
  return info;
}

void describe(RTsums sums, RTstats& stats) {
  const FrameWork& picture = pictureOf(sums);
  picture.describe(stats);
  stats.transport.chosen = sums->sums->frame.transport;
  RTmachineStats& machine = stats.machine;
  std::snprintf(machine.isa, sizeof machine.isa, "%s", sums->sums->identity.isa.c_str());
  std::snprintf(machine.kernel, sizeof machine.kernel, "%s", sums->sums->identity.kernel.c_str());
}

} // namespace

void rtKeepSums(int keep) {
  guarded("rtKeepSums", [&](Context& c) { c.keepSums(keep != 0); });
}

RTsums rtGetSums(RTcontext context) {
  return guardedHere("rtGetSums", RTsums(), [&]() -> RTsums {
    const std::shared_ptr<Context> found = findContext(context);
    require(found != nullptr, RT_INVALID_VALUE, "not a context");
    auto sums = found->sums();
    return sums ? newSums(std::move(sums)) : nullptr;
  });
}

void rtContinueFrom(RTsums sums) {
  guarded("rtContinueFrom", [&](Context& c) {
    requireSums(sums);
    c.continueFrom(sums->sums);
  });
}

RTsums rtMergeSums(RTsums a, RTsums b) {
  return guardedHere("rtMergeSums", RTsums(), [&] {
    requireSums(a);
    return newSums(b ? mergeSums(*a->sums, *b->sums) : condense(*a->sums));
  });
}

void rtDeleteSums(RTsums sums) { delete sums; }

int rtWriteSums(RTsums sums, RTwriteCallback write, void* user) {
  return guardedHere("rtWriteSums", 0, [&] {
    requireSums(sums);
    require(write != nullptr, RT_INVALID_VALUE, "the function is NULL");
    const std::vector<std::byte> bytes = writeSums(*sums->sums);
    return write(bytes.data(), bytes.size(), user) ? 1 : 0;
  });
}

RTsums rtReadSums(const void* data, size_t size) {
  return guardedHere("rtReadSums", RTsums(), [&] {
    require(data != nullptr || size == 0, RT_INVALID_VALUE, "the pointer is NULL");
    return newSums(readSums({static_cast<const std::byte*>(data), size}));
  });
}

int rtGetSumsInfo(RTsums sums, RTsumsInfo* info) {
  if (!sums || !info || info->size < sizeof(size_t)) return 0;
  const size_t size = info->size; // the structure of an older program is shorter
  const RTsumsInfo known = infoOf(*sums->sums);
  std::memcpy(info, &known, std::min(size, sizeof known));
  info->size = size;
  return 1;
}

int rtReadSumsPixels(RTsums sums, RTenum channel, float* out, size_t count) {
  return guardedHere("rtReadSumsPixels", 0, [&] {
    require(out != nullptr, RT_INVALID_VALUE, "the pointer is NULL");
    require(channelComponents(channel) > 0, RT_INVALID_ENUM, "unknown channel");
    require(pictureOf(sums).film().read(channel, {out, count}), RT_INVALID_OPERATION,
            "the frame has no such channel, or the array is too small");
    return 1;
  });
}

int rtGetSumsStats(RTsums sums, RTstats* stats) {
  return guardedHere("rtGetSumsStats", 0, [&] {
    require(stats != nullptr, RT_INVALID_VALUE, "the pointer is NULL");
    const size_t size = stats->size;
    require(size >= sizeof(size_t), RT_INVALID_VALUE,
            "set size to sizeof(RTstats) before the call");
    RTstats known{};
    describe(sums, known);
    known.size = size;
    std::memcpy(stats, &known, std::min(size, sizeof known));
    return 1;
  });
}
