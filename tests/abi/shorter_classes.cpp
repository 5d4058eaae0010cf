// shorter_classes.cpp: plug-ins whose class structure ends earlier than the library's, as that of
// an older header does, are checked by their minor version and render the same.
#include <cstddef>
#include <stdexcept>

#include "shading/plugin_check.h"
#include "small_scene.h"

namespace {

using namespace abi_test;

class ShorterClasses : public SmallScene, public testing::WithParamInterface<const char*> {};

TEST_P(ShorterClasses, DrawAsEver) {
  for (const int transport : {RT_TRANSPORT_AUTO, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, transport);
    shader("Example", GetParam());
    rtParameter1f(rtParameterHandle("b"), 1);
    const RTid object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    squareVertices();
    rtEnd();
    rtEndObject();
    rtInstantiateObject(object);
    const std::vector<float> pixel = picture(1);
    EXPECT_EQ(pixel[0], 0.0f);
    EXPECT_EQ(pixel[1], 0.5f) << transport;
    EXPECT_EQ(stats().leftOut.shaderFaults, 0u);
  }
  EXPECT_TRUE(log.lines.empty()) << log.lines.front();
}

INSTANTIATE_TEST_SUITE_P(Abi, ShorterClasses, testing::Values("shorter_class", "class_truncated"),
                         [](const auto& info) { return std::string(info.param); });

// Checks a plug-in against a made-up ABI: its minor version 0 ended before `surface`, and version 1
// is the library's own. Returns the class, or throws the reason.
RtsClass checked(uint16_t minor, size_t size) {
  RtsClass shaderClass{};
  shaderClass.size = uint32_t(size);
  shaderClass.kind = RTS_SURFACE;
  shaderClass.name = "Example";
  shaderClass.shade = [](const RtsHost*, RtsBatch*, const RtsHits*, RtsShading*) {};
  shaderClass.surface = [](const RtsHost*, RtsBatch*, const RtsHits*, RtsSurface*) {};
  const RtsClass* const classes[] = {&shaderClass};
  const RtsPlugin plugin{RTS_MAGIC, RTS_ABI_MAJOR, minor, sizeof(RtsPlugin), 1, classes};
  const size_t bytes[] = {offsetof(RtsClass, surface), sizeof(RtsClass)};
  return openrt::checkPlugin(&plugin, 0, "example.so", bytes).at(0);
}

std::string refusal(uint16_t minor, size_t size) {
  try {
    checked(minor, size);
  } catch (const std::runtime_error& error) { return error.what(); }
  return {};
}

TEST(OlderMinor, EndsWhereItsStructuresEnded) {
  const RtsClass older = checked(0, offsetof(RtsClass, surface));
  EXPECT_NE(older.shade, nullptr);
  EXPECT_EQ(older.surface, nullptr) << "the plug-in's memory has something there";
  EXPECT_NE(checked(1, sizeof(RtsClass)).surface, nullptr);
  EXPECT_EQ(refusal(0, sizeof(RtsClass)),
            "shader library example.so: claims a class structure of " +
                std::to_string(sizeof(RtsClass)) + " bytes; that of ABI 1.0 has " +
                std::to_string(offsetof(RtsClass, surface)));
  EXPECT_EQ(refusal(2, sizeof(RtsClass)),
            "shader library example.so: made for shader ABI 1.2; this library has 1.1");
}

} // namespace
