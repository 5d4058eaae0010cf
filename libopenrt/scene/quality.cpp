#include "scene/quality.h"

#include <cfloat>
#include <climits>
#include <cstdio>
#include <string_view>
#include <type_traits>

#include "scene/transports.h"

namespace openrt {
namespace {

using Frame = edit::FrameSettingsT;

// Makes the accessors of a member of a frame.
template <auto member> double get(const Frame& frame) { return double(frame.*member); }
template <auto member> void set(Frame& frame, double value) {
  frame.*member = static_cast<std::remove_reference_t<decltype(frame.*member)>>(value);
}

constexpr size_t size = sizeof(RTqualityInfo);
constexpr bool mayDiffer = true;

// Columns of info: size, setting, name, real, range, default, 0 is automatic, choices, text.
constexpr QualitySetting table[] = {
    {{size, RT_SAMPLES_PER_PIXEL, "samples", 0, 1, 65536, 16, 0, nullptr, "samples per pixel"},
     get<&Frame::samples>,
     set<&Frame::samples>,
     mayDiffer},
    {{size, RT_MAX_DEPTH, "depth", 0, 0, 10000, 25, 0, nullptr,
      "maximum number of surfaces on a path"},
     get<&Frame::depth>,
     set<&Frame::depth>},
    {{size, RT_SEED, "seed", 0, INT_MIN, INT_MAX, 0, 0, nullptr,
      "selects another set of sample positions"},
     [](const Frame& frame) { return double(static_cast<int>(frame.seed)); },
     [](Frame& frame, double value) {
       frame.seed = static_cast<uint32_t>(static_cast<int>(value));
     },
     mayDiffer},
    {{size, RT_SHADOWS, "shadows", 0, 0, 1, 1, 0, "off on", "whether lights cast shadows"},
     get<&Frame::shadows>,
     set<&Frame::shadows>},
    {{size, RT_TRANSPORT, "transport", 0, RT_TRANSPORT_AUTO, std::size(transports) - 1,
      RT_TRANSPORT_AUTO, 0, transportChoices.data(), "light transport algorithm"},
     get<&Frame::transport>,
     set<&Frame::transport>},
    {{size, RT_REPLICATES, "replicates", 0, 1, 1024, 0, 1, nullptr,
      "independent replicates of a pixel's samples"},
     get<&Frame::replicates>,
     set<&Frame::replicates>},
    {{size, RT_TARGET_ERROR, "error", 1, 0, 1, 0, 0, nullptr,
      "mean relative half-width of the error bars at which sampling ends; 0: none"},
     get<&Frame::targetError>,
     set<&Frame::targetError>},
    {{size, RT_TIME_LIMIT, "time_limit", 1, 0, 1e6, 0, 0, nullptr,
      "seconds after which no further round of samples begins; 0: none"},
     get<&Frame::timeLimit>,
     set<&Frame::timeLimit>,
     mayDiffer},
    {{size, RT_ENERGY_CUT, "energy_cut", 1, 0, 1, 1.0 / 4096, 0, nullptr,
      "fraction of the camera ray below which the transport whitted ends branches"},
     get<&Frame::energyCut>,
     set<&Frame::energyCut>},
    {{size, RT_CLAMP, "clamp", 1, 0, double(FLT_MAX), 0, 0, nullptr,
      "upper bound of a sample's radiance in each colour; 0: none"},
     get<&Frame::clamp>,
     set<&Frame::clamp>},
    {{size, RT_PROGRESSIVE, "progressive", 0, 0, 1, 0, 0, "off on",
      "whether the whole picture is made early and then improved"},
     get<&Frame::progressive>,
     set<&Frame::progressive>,
     mayDiffer},
    {{size, RT_FRAMES_IN_FLIGHT, "frames_in_flight", 0, 1, 64, 1, 0, nullptr,
      "backend=cluster: frames that rtSwapBuffers leaves unfinished"},
     nullptr,
     nullptr},
    {{size, RT_TILE_SIZE, "tile", 0, 4, largestTile, 0, 1, nullptr, "edge of tiles in pixels"},
     get<&Frame::tile>,
     set<&Frame::tile>},
    {{size, RT_FOLLOW_IMAGES, "follow_images", 0, 0, 1, 0, 0, "off on",
      "whether depth, normal, albedo, position, name and motion describe what mirrors and smooth "
      "glass show"},
     get<&Frame::followImages>,
     set<&Frame::followImages>},
    {{size, RT_JITTER, "jitter", 0, 0, 1, 0, 0, "off on",
      "whether one sample per pixel lies anywhere in its pixel instead of in the middle"},
     get<&Frame::jitter>,
     set<&Frame::jitter>},
    {{size, RT_LIGHT_STRIDE, "light_stride", 0, 1, 4, 1, 0, nullptr,
      "pixels each way of the blocks in which one pixel gets light"},
     get<&Frame::lightStride>,
     set<&Frame::lightStride>},
    {{size, RT_VIEW, "view", 0, 0, double(INT32_MAX), 0, 0, nullptr,
      "number of the sequence of frames that motion refers to"},
     get<&Frame::view>,
     set<&Frame::view>,
     mayDiffer},
    {{size, RT_MEASURE, "measure", 0, RT_MEASURE_NOTHING, RT_MEASURE_ILLUMINANCE,
      RT_MEASURE_NOTHING, 0, "nothing luminance illuminance",
      "whether pixels are photometric readings"},
     get<&Frame::measure>,
     set<&Frame::measure>},
    {{size, RT_DEPTH_ALONG, "depth_along", 0, RT_DEPTH_ALONG_AXIS, RT_DEPTH_ALONG_RAY,
      RT_DEPTH_ALONG_AXIS, 0, "axis ray", "what depth is measured along"},
     get<&Frame::depthAlong>,
     set<&Frame::depthAlong>},
    {{size, RT_PATIENCE, "patience", 1, 0, 3600, 0, 0, nullptr,
      "seconds that a frame waits while acceleration structures are built; 0: until they are"},
     nullptr,
     nullptr},
};

} // namespace

std::string qualityFault(const RTqualityInfo& info, double value) {
  char text[160];
  std::snprintf(text, sizeof text, "%s: %.10g to %.10g%s expected, not %.10g", info.name,
                info.minimum, info.maximum, info.zeroIsAuto ? ", or 0," : "", value);
  return text;
}

std::string qualityText(const RTqualityInfo& info, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  if (!info.choices) return text;
  std::string_view left = info.choices;
  for (double choice = info.minimum; choice < value; choice++) {
    const size_t blank = left.find(' ');
    left.remove_prefix(blank == left.npos ? left.size() : blank + 1);
  }
  return std::string(left.substr(0, left.find(' ')));
}

std::span<const QualitySetting> qualitySettings() { return table; }

const QualitySetting* findQuality(RTenum quality) {
  for (const QualitySetting& setting : table)
    if (setting.info.quality == quality) return &setting;
  return nullptr;
}

const char* invalidQuality(const edit::FrameSettingsT& frame) {
  for (const QualitySetting& setting : table)
    if (setting.get && !setting.allows(setting.get(frame))) return setting.info.name;
  return nullptr;
}

bool wantsError(const edit::FrameSettingsT& frame) {
  return (frame.channels & (RT_ERROR | RT_TRUST)) || frame.targetError > 0 || frame.timeLimit > 0;
}

bool showsNoLight(const edit::FrameSettingsT& frame) {
  return !(frame.channels & (RT_RGBA | RT_VARIANCE)) && !wantsError(frame);
}

} // namespace openrt
