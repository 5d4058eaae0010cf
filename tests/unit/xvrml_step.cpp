// xvrml_step.cpp: STEP models: damaged and hostile files, a process that lies, and what happens
// without the program. tests/python/test_step.py compares models with closed forms.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <regex>

#include <unistd.h>

#include "decode/decoder.h"
#include "parse/loader.h"
#include "unit/liar.h"
#include "xvrml/file_head.h"
#include "xvrml/world.h"

namespace xvrml::test {
namespace {

std::string model(const char* name) {
  std::ifstream file(std::string("tests/unit/models/") + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Step : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }

  // Loads a model into the budget. Returns why it cannot be read; "" if it can.
  std::string whyNot(const std::string& bytes) {
    std::ofstream(file_, std::ios::binary) << bytes;
    try {
      world = loadWorldInto(budget, file_.string(), {}, 0);
      for (const Diagnostic& one : world->diagnostics.list())
        if (one.severity == Severity::error) return one.message;
    } catch (const LoadError& error) { return error.diagnostic.message; }
    return "";
  }

  BudgetPtr budget = std::make_shared<Budget>(uint64_t(1) << 30);
  std::unique_ptr<World> world;

 private:
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("xvrml_step_" + std::to_string(getpid()) + ".step");
};

class StepModels : public Step {
 protected:
  void SetUp() override {
    if (const std::string why = whyNotReadable(Encoding::step); !why.empty()) GTEST_SKIP() << why;
  }
};

// A binary glTF file without a scene.
std::string emptyGlb() {
  std::string json = R"({"asset":{"version":"2.0"},"scenes":[{}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string glb = "glTF";
  for (const size_t word : {size_t(2), 20 + json.size(), json.size(), size_t(0x4e4f534a)}) {
    const auto word32 = uint32_t(word);
    glb.append(reinterpret_cast<const char*>(&word32), sizeof word32);
  }
  return glb + json;
}

TEST_F(Step, TheContentDecidesAndNamesTheEncoding) {
  EXPECT_EQ(encodingName(Encoding::step), "STEP");
  EXPECT_TRUE(isMesh(Encoding::step));
  EXPECT_EQ(meshSuffixes(Encoding::step), ".step .stp .stpz");
}

TEST_F(Step, WithoutTheProgramAMessageSaysSo) {
  setenv("XVRML_STEP_READER", "/nonexistent/xvrml-step-reader", 1);
  const std::string said = whyNot("ISO-10303-21;\n"), why = whyNotReadable(Encoding::step);
  unsetenv("XVRML_STEP_READER");
  EXPECT_NE(said.find("this STEP model cannot be read: no program decodes it: "
                      "/nonexistent/xvrml-step-reader"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("libocct-data-exchange-dev"), std::string::npos) << said;
  EXPECT_NE(why.find("/nonexistent/xvrml-step-reader"), std::string::npos) << why;
}

TEST_F(Step, AProcessThatLiesGivesAMessage) {
  using decoding::Contents;
  using decoding::Op;
  const auto said = [&](const std::function<void(Liar&)>& lie) {
    budget = std::make_shared<Budget>(uint64_t(1) << 30);
    Liar liar(budget->stepReader, stepReader);
    lie(liar);
    liar.ends();
    return whyNot("ISO-10303-21;\n");
  };
  const auto contains = [&](const char* what, const std::function<void(Liar&)>& lie) {
    const std::string got = said(lie);
    EXPECT_NE(got.find(what), std::string::npos) << got << " instead of " << what;
  };
  const std::string glb = emptyGlb();
  const auto answer = [](const std::string& bytes) {
    return [bytes](Liar& l) {
      l.says(Op::contents, Contents{bytes.size(), 1, 1, 1}).says(Op::bytes, bytes).says(Op::end);
    };
  };
  EXPECT_EQ(said(answer(glb)), "");
  contains("does not fit into it", answer(glb.substr(0, glb.size() - 4)));
  contains("not valid JSON", answer("not a model"));
  contains("broke the protocol", [&](Liar& l) { l.says(Op::contents, Contents{8, 2, 1, 1}); });
  contains("broke the protocol", [&](Liar& l) { l.says(Op::contents, Contents{8, 1, 1, 4}); });
  contains("worldBytes", [&](Liar& l) { l.says(Op::contents, Contents{~0ull, 1, 1, 1}); });
  contains("xvrml-step-reader, which decodes such files, ended", [&](Liar& l) {
    l.says(Op::contents, Contents{glb.size(), 1, 1, 1});
  });
  contains("\\x1b", [&](Liar& l) { l.says(Op::failed, "a \x1b[2J trick"); });
  Contents partly{glb.size(), 1, 1, 1};
  partly.leftOut = 3;
  EXPECT_EQ(said([&](Liar& l) { l.says(Op::contents, partly).says(Op::bytes, glb).says(Op::end); }),
            "");
  ASSERT_EQ(world->diagnostics.list().size(), 1u);
  EXPECT_EQ(world->diagnostics.list()[0].message,
            "3 faces of the STEP model are left out: no triangles could be made of them");
}

TEST_F(StepModels, EachFileHasAProcessThatEndsWithIt) {
  EXPECT_EQ(whyNot(model("machine.step")), "");
  ASSERT_TRUE(budget->stepReader);
  EXPECT_EQ(budget->stepReader->processNumber(), 0);
  EXPECT_EQ(whyNot(model("inch.step")), "");
}

TEST_F(StepModels, BadFilesGiveOneMessage) {
  const std::string whole = model("machine.step");
  EXPECT_EQ(whyNot(whole.substr(0, whole.size() / 2)).find("this STEP model cannot be read: Line "),
            0u);
  EXPECT_NE(whyNot("ISO-10303-21;\nrubbish").find("Line 3"), std::string::npos);
  const std::string head = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n", end = "ENDSEC;\n"
                                                                             "END-ISO-10303-21;\n";
  EXPECT_NE(whyNot(head + end).find("it is no STEP file that can be read"), std::string::npos);
  EXPECT_NE(whyNot(head + "#1=PRODUCT('','','',());\n" + end).find("it holds no model"),
            std::string::npos);
  EXPECT_NE(whyNot(head + "#1=X(#1);\n" + end), "");
  EXPECT_EQ(whyNot(whole), "");
}

TEST_F(StepModels, MemoryIsBounded) {
  budget = std::make_shared<Budget>(uint64_t(1) << 16);
  EXPECT_NE(whyNot(model("round.step")).find("worldBytes"), std::string::npos);
}

// Changes numbers, references, characters or the end of a file.
std::string mutant(const std::string& whole, std::mt19937& random) {
  static const std::regex number("-?[0-9]+\\.[0-9]*(E[-+]?[0-9]+)?"), reference("#[0-9]+");
  static const char* const numbers[] = {"0.", "1E300", "-1.", "1E-300", "1E9", "-1E5", "3.7"};
  std::string bytes = whole;
  const auto some = [&](size_t count) { return size_t(random()) % count; };
  if (some(8) == 0) bytes.resize(some(bytes.size()));
  const size_t kind = some(3), changes = 1 + some(4);
  for (size_t i = 0; i < changes && !bytes.empty(); ++i) {
    if (kind == 0) {
      bytes[some(bytes.size())] = "0123456789#(),.$*'E-=;"[some(22)];
      continue;
    }
    const auto begin = bytes.cbegin() + ptrdiff_t(some(bytes.size()));
    std::smatch at, from;
    if (!std::regex_search(begin, bytes.cend(), at, kind == 1 ? number : reference)) continue;
    std::string by = numbers[some(std::size(numbers))];
    if (kind == 2 && std::regex_search(bytes.cbegin() + ptrdiff_t(some(bytes.size())), bytes.cend(),
                                       from, reference))
      by = from.str();
    bytes.replace(size_t(at[0].first - bytes.cbegin()), size_t(at.length()), by);
  }
  return bytes;
}

// XVRML_DECODER_MUTANTS=10000 makes as many of each file.
TEST_F(StepModels, DamagedFilesGiveAMessageOrAModel) {
  const char* const wanted = std::getenv("XVRML_DECODER_MUTANTS");
  const int mutants = wanted ? std::atoi(wanted) : 5;
  DecoderKind hurried = stepReader;
  hurried.secondsPerFile = 1; // some changes make Open CASCADE compute for ever
  std::mt19937 random(1);
  for (const char* name : {"machine.step", "round.step"}) {
    const std::string whole = model(name);
    for (int i = 0; i < mutants; ++i) {
      if (i % 50 == 0) { // a world's files may end 100 processes
        budget = std::make_shared<Budget>(uint64_t(1) << 30);
        budget->stepReader = std::make_shared<Decoder>(hurried);
      }
      whyNot(mutant(whole, random));
    }
    EXPECT_EQ(whyNot(whole), "");
  }
}

} // namespace
} // namespace xvrml::test
