// openrt_api_frames.cpp: Tests frame settings, the sequence of frames, reading pixels, statistics
// and queries; the order of edits.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "scene/quality.h"
#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;

class Frames : public ApiTest {};

TEST_F(Frames, SettingsTravelWhenTheyChange) {
  rtFrameBuffer(320, 240, RT_RGBA | RT_DEPTH);
  rtQuality(RT_SEED, 7);
  rtQuality(RT_SHADOWS, 0);
  const auto found = edits<edit::FrameSettingsT>(commit());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0]->width == 320 && found[0]->height == 240 &&
              found[0]->channels == (RT_RGBA | RT_DEPTH));
  EXPECT_TRUE(found[0]->samples == 16 && found[0]->depth == 25 && found[0]->seed == 7 &&
              !found[0]->shadows);
  EXPECT_TRUE(commit().edits.edits.empty());
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtQuality(RT_MAX_DEPTH, 0);
  EXPECT_EQ(edits<edit::FrameSettingsT>(commit()).at(0)->samples, 1u);
}

TEST_F(Frames, BadSettingsAreErrorsAndChangeNothing) {
  commit();
  for (int bad : {0, -1, 65537}) {
    EXPECT_FAILS(RT_INVALID_VALUE, rtFrameBuffer(bad, 1, RT_RGBA));
    EXPECT_FAILS(RT_INVALID_VALUE, rtFrameBuffer(1, bad, RT_RGBA));
    EXPECT_FAILS(RT_INVALID_VALUE, rtQuality(RT_SAMPLES_PER_PIXEL, bad));
  }
  EXPECT_FAILS(RT_INVALID_VALUE, rtFrameBuffer(65536, 65536, RT_RGBA));
  EXPECT_FAILS(RT_INVALID_VALUE, rtFrameBuffer(1, 1, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtFrameBuffer(1, 1, 1 << 20));
  EXPECT_FAILS(RT_INVALID_VALUE, rtQuality(RT_MAX_DEPTH, -1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtQuality(RT_MAX_DEPTH, 10001));
  EXPECT_FAILS(RT_INVALID_VALUE, rtQuality(RT_SHADOWS, 2));
  EXPECT_FAILS(RT_INVALID_ENUM, rtQuality(99, 1));
  EXPECT_TRUE(commit().edits.edits.empty());
}

TEST_F(Frames, AWrongSettingIsNamedWithItsRangeAndValue) {
  const auto message = [] {
    EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE));
    return std::string(rtGetErrorMessage());
  };
  rtQuality(RT_MAX_DEPTH, 10001);
  EXPECT_EQ(message(), "rtQuality: depth: 0 to 10000 expected, not 10001");
  rtQuality(RT_TILE_SIZE, 3);
  EXPECT_EQ(message(), "rtQuality: tile: 4 to 128, or 0, expected, not 3");
  rtQualityf(RT_TARGET_ERROR, 1.5);
  EXPECT_EQ(message(), "rtQualityf: error: 0 to 1 expected, not 1.5");
}

TEST_F(Frames, TheTableOfQualitySettingsIsWhatIsAccepted) {
  const auto set = [](const RTqualityInfo& info, double value) {
    if (info.isReal)
      rtQualityf(info.quality, value);
    else
      rtQuality(info.quality, int(value));
    return rtGetError();
  };
  RTqualityInfo info{};
  EXPECT_EQ(rtGetQualityInfo(0, &info), 0) << "its size is not set";
  info.size = sizeof info;
  EXPECT_EQ(rtGetQualityInfo(-1, &info), 0);
  EXPECT_EQ(rtGetQualityInfo(0, nullptr), 0);
  std::set<std::string> names;
  std::set<RTenum> settings;
  int count = 0;
  for (; rtGetQualityInfo(count, &info); count++) {
    SCOPED_TRACE(info.name);
    EXPECT_EQ(info.size, sizeof info);
    names.insert(info.name);
    settings.insert(info.quality);
    EXPECT_STRNE(info.text, "");
    for (const double good : {info.minimum, info.maximum, info.defaultValue})
      EXPECT_EQ(set(info, good), RTenum(RT_NO_ERROR)) << good;
    EXPECT_EQ(set(info, 0),
              RTenum(info.zeroIsAuto || info.minimum <= 0 ? RT_NO_ERROR : RT_INVALID_VALUE));
    for (const double value :
         {info.minimum, info.maximum, info.defaultValue, 0.0, info.minimum - 1, info.maximum + 1})
      if (info.isReal || (value >= INT32_MIN && value <= INT32_MAX)) {
        EXPECT_EQ(rtIsQualityAllowed(info.quality, value), set(info, value) == RTenum(RT_NO_ERROR))
            << value;
      }
    EXPECT_EQ(rtIsQualityAllowed(info.quality, NAN), 0);
    EXPECT_EQ(rtIsQualityAllowed(info.quality, info.defaultValue), 1);
    if (!info.isReal) { EXPECT_EQ(rtIsQualityAllowed(info.quality, info.minimum + .5), 0); }
    if (info.quality == RT_SEED) continue; // every int is a seed
    EXPECT_EQ(set(info, info.minimum - 1),
              RTenum(info.zeroIsAuto && info.minimum == 1 ? RT_NO_ERROR : RT_INVALID_VALUE));
    // The maximum is the largest float, or the largest int.
    if (info.quality == RT_CLAMP || info.quality == RT_VIEW) continue;
    EXPECT_EQ(set(info, info.maximum + 1), RTenum(RT_INVALID_VALUE));
  }
  EXPECT_EQ(rtIsQualityAllowed(0, 0), 0);
  EXPECT_EQ(rtIsQualityAllowed(99, 1), 0);
  EXPECT_EQ(names.size(), size_t(count));
  EXPECT_EQ(settings.size(), size_t(count));
  EXPECT_EQ(*settings.begin(), RTenum(RT_SAMPLES_PER_PIXEL));
  EXPECT_EQ(*settings.rbegin(), RTenum(count)) << "the numbers have gaps";
}

// A recording or message that lacks a field means the default of edits.fbs.
TEST(QualityTable, DefaultsAreThoseOfTheSchema) {
  const edit::FrameSettingsT missing;
  for (const QualitySetting& setting : qualitySettings()) {
    if (!setting.get) continue; // not part of a frame
    const RTenum quality = setting.info.quality;
    // deliberate differences: no recording lacks these fields, which are as old as recordings
    const bool differs = quality == RT_SAMPLES_PER_PIXEL || quality == RT_MAX_DEPTH;
    EXPECT_EQ(setting.get(missing), differs ? 0 : setting.info.defaultValue) << setting.info.name;
  }
}

TEST(QualityTable, ValuesAreWrittenAsTheirChoices) {
  const auto text = [](RTenum quality, double value) {
    return qualityText(findQuality(quality)->info, value);
  };
  EXPECT_EQ(text(RT_MAX_DEPTH, 25), "25");
  EXPECT_EQ(text(RT_TRANSPORT, RT_TRANSPORT_AUTO), "auto");
  EXPECT_EQ(text(RT_TRANSPORT, RT_TRANSPORT_LIGHT), "light");
  EXPECT_EQ(text(RT_SHADOWS, 1), "on");
  EXPECT_EQ(text(RT_DEPTH_ALONG, RT_DEPTH_ALONG_RAY), "ray");
}

// All settings decide what sums hold, except those that say how far a picture has come.
TEST(QualityTable, SumsOfOtherSettingsAreNotMixed) {
  std::vector<std::string> mayDiffer;
  for (const QualitySetting& setting : qualitySettings())
    if (setting.get && setting.mayDiffer) mayDiffer.push_back(setting.info.name);
  EXPECT_EQ(mayDiffer,
            (std::vector<std::string>{"samples", "seed", "time_limit", "progressive", "view"}));
}

TEST_F(Frames, TheTableOfTransportsIsWhatIsAccepted) {
  RTtransportInfo info{};
  EXPECT_EQ(rtGetTransportInfo(0, &info), 0) << "its size is not set";
  info.size = sizeof info;
  EXPECT_EQ(rtGetTransportInfo(0, nullptr), 0);
  std::string choices;
  RTenum count = 0;
  for (; rtGetTransportInfo(count, &info); count++) {
    SCOPED_TRACE(info.name);
    EXPECT_EQ(info.size, sizeof info);
    EXPECT_EQ(info.transport, count);
    choices += (count ? " " : "") + std::string(info.name);
    EXPECT_STRNE(info.text, "");
    std::string claim = info.claim;
    for (const std::string known : {"{depth}", "{shadows}"})
      if (const size_t at = claim.find(known); at != claim.npos) claim.erase(at, known.size());
    EXPECT_EQ(claim.find_first_of("{}"), claim.npos) << "an unknown placeholder, or one twice";
    EXPECT_NE(claim, "");
    EXPECT_LE(info.tracesLamps, info.tracesPaths);
    EXPECT_EQ(rtIsQualityAllowed(RT_TRANSPORT, count), 1);
  }
  EXPECT_EQ(rtIsQualityAllowed(RT_TRANSPORT, count), 0);
  RTqualityInfo quality{};
  quality.size = sizeof quality;
  for (int i = 0; rtGetQualityInfo(i, &quality) && quality.quality != RT_TRANSPORT; i++) {}
  EXPECT_EQ(choices, quality.choices);
  // A structure of an older program ends earlier.
  info = {};
  info.size = offsetof(RTtransportInfo, name);
  EXPECT_EQ(rtGetTransportInfo(RT_TRANSPORT_PATH, &info), 1);
  EXPECT_EQ(info.transport, RTenum(RT_TRANSPORT_PATH));
  EXPECT_EQ(info.name, nullptr);
}

TEST_F(Frames, TheTableOfChannelsIsWhatFramesHave) {
  RTchannelInfo info{};
  EXPECT_EQ(rtGetChannelInfo(0, &info), 0) << "its size is not set";
  info.size = sizeof info;
  EXPECT_EQ(rtGetChannelInfo(-1, &info), 0);
  EXPECT_EQ(rtGetChannelInfo(0, nullptr), 0);
  std::set<std::string> names, planes;
  uint32_t channels = 0;
  int count = 0, components = 0;
  for (; rtGetChannelInfo(count, &info); count++) {
    SCOPED_TRACE(info.name);
    EXPECT_EQ(info.size, sizeof info);
    names.insert(info.name);
    channels |= info.channel;
    components += info.components;
    std::istringstream words(info.planes);
    for (std::string plane; words >> plane;) planes.insert(plane);
    if (info.text) { EXPECT_STRNE(info.text, ""); }
    rtFrameBuffer(4, 4, info.channel);
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
  }
  EXPECT_EQ(names.size(), size_t(count));
  EXPECT_EQ(planes.size(), size_t(components));
  EXPECT_EQ(channels, (1u << count) - 1) << "the bits have gaps";
  rtFrameBuffer(4, 4, 1u << count);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE));
}

TEST(FramesWithoutBuffer, AFrameNeedsASize) {
  const RTcontext context = rtNewContext("backend=null");
  EXPECT_FAILS(RT_INVALID_OPERATION, rtRender());
  EXPECT_FAILS(RT_INVALID_OPERATION, rtSwapBuffers());
  rtDeleteContext(context);
}

TEST(FramesWithoutBuffer, NothingInFlightHasNoSnapshot) {
  float pixels[4];
  EXPECT_EQ(rtSnapshot(nullptr, RT_RGBA, pixels, 4), 0);
  EXPECT_RT_ERROR(RT_INVALID_VALUE);
  const RTcontext context = rtNewContext("backend=null");
  EXPECT_EQ(rtSnapshot(context, RT_RGBA, nullptr, 4), 0);
  EXPECT_RT_ERROR(RT_INVALID_VALUE);
  EXPECT_EQ(rtSnapshot(context, RT_RGBA, pixels, 4), 0);
  EXPECT_RT_ERROR(RT_NO_ERROR);
  rtDeleteContext(context);
}

TEST_F(Frames, SwapHasOneFrameOfLatency) {
  float pixels[32];
  rtSwapBuffers();
  EXPECT_EQ(captured->starts, 1);
  EXPECT_EQ(captured->waits, 0);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtReadPixels(RT_RGBA, pixels, 32));
  rtFrameBuffer(2, 2, RT_DEPTH);
  rtSwapBuffers();
  EXPECT_EQ(captured->starts, 2);
  EXPECT_EQ(captured->waits, 1);
  rtReadPixels(RT_RGBA, pixels, 32); // the first frame: 4x2, colour
  EXPECT_FAILS(RT_INVALID_OPERATION, rtReadPixels(RT_DEPTH, pixels, 32));
  rtSwapBuffers();
  rtReadPixels(RT_DEPTH, pixels, 4);
  EXPECT_EQ(pixels[3], float(RT_DEPTH));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtReadPixels(RT_RGBA, pixels, 32));
}

TEST_F(Frames, RenderDropsTheFrameInFlight) {
  rtSwapBuffers();
  rtRender();
  EXPECT_EQ(captured->cancels, 1);
  EXPECT_EQ(captured->starts, 2);
  EXPECT_EQ(captured->waits, 2);
  EXPECT_TRUE(captured->commits.back()->edits.render);
}

TEST_F(Frames, ReadingIsChecked) {
  float pixels[32];
  EXPECT_FAILS(RT_INVALID_OPERATION, rtReadPixels(RT_RGBA, pixels, 32));
  rtRender();
  EXPECT_FAILS(RT_INVALID_ENUM, rtReadPixels(0, pixels, 32));
  EXPECT_FAILS(RT_INVALID_ENUM, rtReadPixels(RT_RGBA | RT_DEPTH, pixels, 32));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtReadPixels(RT_NORMAL, pixels, 32));
  EXPECT_FAILS(RT_INVALID_VALUE, rtReadPixels(RT_RGBA, pixels, 31));
  EXPECT_FAILS(RT_INVALID_VALUE, rtReadPixels(RT_RGBA, nullptr, 32));
  rtReadPixels(RT_RGBA, pixels, 32);
}

TEST_F(Frames, StatisticsMergeBothSides) {
  const RTid object = triangleObject();
  rtInstantiateObject(object);
  rtInstantiateObject(object);
  RTid textures[3];
  rtGenTextures(3, textures);
  RTstats stats;
  std::memset(&stats, 0xff, sizeof(stats));
  stats.size = sizeof(stats);
  rtGetStats(&stats);
  EXPECT_TRUE(stats.scene.objects == 1 && stats.scene.instances == 2 && stats.scene.textures == 3 &&
              stats.scene.lights == 0);
  EXPECT_EQ(stats.rays.camera, 42u);
  EXPECT_EQ(stats.rejected.primitives, 1u);
  EXPECT_EQ(stats.size, sizeof(stats));
}

TEST_F(Frames, StatisticsRespectAnOlderStructure) {
  RTstats stats;
  std::memset(&stats, 0xff, sizeof(stats));
  stats.size = offsetof(RTstats, scene.lights);
  rtGetStats(&stats);
  EXPECT_EQ(stats.scene.instances, 0u);
  EXPECT_EQ(stats.scene.lights, ~uint64_t(0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtGetStats(nullptr));
  stats.size = 1;
  EXPECT_FAILS(RT_INVALID_VALUE, rtGetStats(&stats));
}

TEST_F(Frames, QueriesAskTheLastCommittedScene) {
  const RTray ray = {{0, 0, 0}, 0, {0, 0, -1}, 1};
  RThit hit;
  uint8_t occluded = 9;
  rtCastRays(1, &ray, &hit);
  rtOccludedRays(1, &ray, &occluded);
  EXPECT_TRUE(std::isinf(hit.t) && hit.instance == 0 && occluded == 0); // nothing is committed
  rtRender();
  rtCastRays(1, &ray, &hit);
  rtOccludedRays(1, &ray, &occluded);
  EXPECT_TRUE(hit.t == 7 && occluded == 1);
  rtCastRays(0, nullptr, nullptr);
  EXPECT_FAILS(RT_INVALID_VALUE, rtCastRays(1, nullptr, &hit));
  EXPECT_FAILS(RT_INVALID_VALUE, rtCastRays(1, &ray, nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtOccludedRays(1, &ray, nullptr));
}

// Edits come in the order that scene_state.h promises, whatever the order of the calls.
TEST_F(Frames, EditsComeInTheirOrder) {
  const RTid classes[2] = {rtNewShaderClass("Lamp", "everything"),
                           rtNewShaderClass("Plain", "everything")};
  const RTid oldLight = rtUseLight(rtNewShader(classes[0])), oldObject = triangleObject(),
             oldInstance = rtInstantiateObject(oldObject);
  const RTid oldShader = rtNewShader(classes[1]);
  const unsigned char texel = 1;
  RTid textures[2];
  rtGenTextures(2, textures);
  rtBindTexture(textures[0]);
  rtTexImage2D(1, 1, 1, RT_UNSIGNED_BYTE, &texel);
  commit();

  rtQuality(RT_SEED, 1);
  rtUseEnvironment(rtNewShader(rtNewShaderClass("Sky", "everything")));
  rtUseCamera(rtNewShader(rtNewShaderClass("Eye", "everything")));
  const RTid surface = rtNewShader(rtNewShaderClass("Everything", "everything"));
  rtDefaultShader(surface);
  rtUseLight(rtNewShader(classes[0]));
  rtInstantiateObject(triangleObject());
  rtBindShader(surface);
  rtParameter1i(0, 1);
  rtBindTexture(textures[1]);
  rtTexImage2D(1, 1, 1, RT_UNSIGNED_BYTE, &texel);
  rtDeleteTexture(textures[0]);
  rtDeleteShader(oldShader);
  rtDeleteObject(oldObject);
  rtRemoveLight(oldLight);
  EXPECT_FAILS(RT_INVALID_ID, rtDeleteInstance(oldInstance)); // deleted together with its object

  using edit::Any;
  const std::vector<Any> rank = {Any::DeleteLight,  Any::DeleteInstance, Any::Texture,
                                 Any::ShaderClass,  Any::Shader,         Any::Object,
                                 Any::Instance,     Any::Light,          Any::Camera,
                                 Any::Environment,  Any::DefaultShader,  Any::FrameSettings,
                                 Any::DeleteObject, Any::DeleteShader,   Any::DeleteTexture};
  std::vector<size_t> seen;
  for (const auto& entry : commit().edits.edits) {
    // Parameters follow their shader.
    const Any type = entry->any.type == Any::Parameter ? Any::Shader : entry->any.type;
    seen.push_back(size_t(std::find(rank.begin(), rank.end(), type) - rank.begin()));
  }
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  EXPECT_EQ(seen.size(), rank.size()); // each kind occurs
}

// Where frames can overlap, the next frame is started before the API waits for the last one.
TEST_F(Frames, ABackendThatPipelinesHasTheNextFrameBeforeItIsAskedForTheLast) {
  const auto backendCalls = [&] { return std::exchange(captured->backendCalls, ""); };
  const auto finished = [&] {
    RTstats stats{};
    stats.size = sizeof(stats);
    rtGetStats(&stats);
    return stats.frame;
  };
  float pixels[32];
  rtSwapBuffers();
  rtSwapBuffers();
  EXPECT_EQ(backendCalls(), "aswas");
  EXPECT_EQ(finished(), 1u);
  EXPECT_EQ(rtFinishFrame(), 1);
  EXPECT_EQ(rtFinishFrame(), 0);
  EXPECT_EQ(backendCalls(), "w");
  EXPECT_EQ(finished(), 2u);

  captured->pipelines = true;
  rtSwapBuffers();
  rtSwapBuffers();
  EXPECT_EQ(backendCalls(), "asasw");
  EXPECT_EQ(finished(), 3u);
  rtQuality(RT_FRAMES_IN_FLIGHT, 3);
  rtFrameBuffer(8, 2, RT_RGBA);
  rtSwapBuffers();
  rtSwapBuffers();
  rtSwapBuffers();
  EXPECT_EQ(backendCalls(), "asasasw");
  EXPECT_EQ(finished(), 4u);
  rtReadPixels(RT_RGBA, pixels, 32); // pixels of the previous size
  EXPECT_EQ(rtFinishFrame(), 1);
  EXPECT_FAILS(RT_INVALID_VALUE, rtReadPixels(RT_RGBA, pixels, 32));
  rtRender(); // cancels the frames that are left
  EXPECT_EQ(backendCalls(), "wcwwasw");
  EXPECT_EQ(finished(), 8u);
  EXPECT_EQ(rtFinishFrame(), 0);
}

// While a frame is being handed over, the backend does not know it yet. A cancellation at that time
// reaches the frame all the same.
TEST_F(Frames, ACancellationWhileAFrameIsBegunIsForThatFrame) {
  const auto backendCalls = [&](const char* cancelIn, void (*call)()) {
    captured->cancelIn = cancelIn;
    captured->backendCalls.clear();
    call();
    return captured->backendCalls;
  };
  EXPECT_EQ(backendCalls("a", rtRender), "acscw");
  EXPECT_EQ(backendCalls("", rtRender), "asw"); // and only that frame
  EXPECT_EQ(backendCalls("s", rtRender), "asccw");
  EXPECT_EQ(backendCalls("", rtSwapBuffers), "as");
  EXPECT_EQ(backendCalls("a", rtSwapBuffers), "wacsc");
  // Cancelled while the API waits for the previous frame: that one ends, the next is complete.
  EXPECT_EQ(backendCalls("w", rtSwapBuffers), "wcas");
  rtCancel(handle);
  EXPECT_EQ(backendCalls("", rtSwapBuffers), "was");
  // rtRender cancels the previous frame and is cancelled itself.
  EXPECT_EQ(backendCalls("w", rtRender), "cwcascwc");
  captured->pipelines = true;
  EXPECT_EQ(backendCalls("", rtSwapBuffers), "as");
  EXPECT_EQ(backendCalls("s", rtSwapBuffers), "asccw");
}

TEST_F(Frames, AFrameThatFailsIsNotTheFinishedOne) {
  captured->pipelines = true;
  rtSwapBuffers();
  rtSwapBuffers();
  captured->failNextWait = true;
  EXPECT_FAILS(RT_CLUSTER_ERROR, rtSwapBuffers());
  RTstats stats{};
  stats.size = sizeof(stats);
  rtGetStats(&stats);
  EXPECT_EQ(stats.frame, 1u);
  EXPECT_EQ(rtFinishFrame(), 1);
  rtGetStats(&stats);
  EXPECT_EQ(stats.frame, 3u);
}

TEST_F(Frames, WorkersAreWrittenAsFarAsThereIsRoom) {
  EXPECT_EQ(rtGetWorkers(rtGetCurrent(), nullptr, 0), 2u);
  RTworker workers[3]{};
  workers[0].size = sizeof(RTworker);
  EXPECT_EQ(rtGetWorkers(rtGetCurrent(), workers, 1), 2u);
  EXPECT_TRUE(workers[0].threads == 3 && workers[1].threads == 0);
  EXPECT_EQ(rtGetWorkers(rtGetCurrent(), workers, 3), 2u);
  EXPECT_TRUE(workers[1].threads == 4 && workers[1].size == sizeof(RTworker) &&
              workers[2].size == 0);
  struct Older { // the struct of a program built with an older header
    size_t size;
    char name[64];
    uint32_t threads;
  } older[2]{};
  older[0].size = sizeof(Older);
  EXPECT_EQ(rtGetWorkers(rtGetCurrent(), reinterpret_cast<RTworker*>(older), 2), 2u);
  EXPECT_TRUE(older[0].threads == 3 && older[1].threads == 4);
}

} // namespace
