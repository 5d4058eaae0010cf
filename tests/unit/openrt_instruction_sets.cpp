// openrt_instruction_sets.cpp: tests that each instruction set of this machine renders, with the
// same bytes each time, and that others are refused.
#include "backend/instruction_sets.h"

#include "unit/drawn_scene.h"

namespace {

using namespace openrt;

std::vector<float> picture(const std::string& isa, uint32_t threads, RTstats& stats) {
  const ShaderRegistry shaders(shaderFolders(""));
  BackendOptions options;
  options.threads = threads;
  options.isa = isa;
  options.shaders = &shaders;
  const auto backend = makeLocalBackend(options);
  const test::Settings settings{.samples = 32};
  for (const auto& commit : test::drawn([&] {
         test::drawRoom();
         test::set(settings);
         rtRender();
       }))
    backend->apply(commit);
  backend->start();
  backend->wait();
  backend->stats(stats);
  std::vector<float> rgba(size_t(settings.width) * size_t(settings.height) * 4);
  EXPECT_TRUE(backend->read(RT_RGBA, rgba));
  return rgba;
}

double brightness(const std::vector<float>& rgba) {
  double sum = 0;
  for (size_t i = 0; i < rgba.size(); i++) sum += i % 4 == 3 ? 0 : rgba[i];
  return sum / double(rgba.size());
}

TEST(InstructionSets, EachRendersTheSameBytesEachTime) {
  RTstats best{};
  const std::vector<float> automatic = picture("auto", 1, best);
  for (const std::string_view name : instructionSets) {
    if (!listsInstructionSet(instructionSetsFrom(best.machine.isa), std::string(name))) continue;
    SCOPED_TRACE(name);
    RTstats stats{};
    const std::vector<float> one = picture(std::string(name), 1, stats);
    EXPECT_EQ(stats.machine.isa, name);
    EXPECT_EQ(picture(std::string(name), 1, stats), one);
    EXPECT_EQ(picture(std::string(name), 3, stats), one);
    EXPECT_NEAR(brightness(one) / brightness(automatic), 1, .02);
    if (name == best.machine.isa) { EXPECT_EQ(one, automatic); }
  }
}

TEST(InstructionSets, OthersAreRefusedAndThoseOfTheMachineNamed) {
  RTstats best{};
  picture("auto", 1, best);
  const std::string expected =
      "expected auto, or one that this machine has: " + instructionSetsFrom(best.machine.isa);
  std::vector<std::string> lacking = {"mmx", "", "AVX2", "avx2,sse2"};
  for (const std::string_view name : instructionSets) {
    if (name == best.machine.isa) break;
    lacking.emplace_back(name);
  }
  for (const std::string& name : lacking) {
    SCOPED_TRACE(name);
    BackendOptions options;
    options.isa = name;
    try {
      makeLocalBackend(options);
      ADD_FAILURE() << "it is accepted";
    } catch (const OptionError& e) { EXPECT_EQ(e.what(), "isa=" + name + ": " + expected); }
    EXPECT_EQ(rtNewContext(("isa=\"" + name + "\"").c_str()), nullptr);
    EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE));
    EXPECT_EQ(rtGetErrorMessage(), "rtNewContext: isa=" + name + ": " + expected);
  }
}

TEST(InstructionSets, AreListedFromTheBestOn) {
  const std::string all = instructionSetsFrom(instructionSets[0]);
  for (const std::string_view name : instructionSets) {
    EXPECT_TRUE(listsInstructionSet(all, std::string(name)));
    EXPECT_EQ(all.substr(all.size() - instructionSetsFrom(name).size()), instructionSetsFrom(name));
  }
  EXPECT_EQ(instructionSetsFrom("mmx"), "");
  EXPECT_FALSE(listsInstructionSet("avx2, sse2", "avx"));
}

} // namespace
