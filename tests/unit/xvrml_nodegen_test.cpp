// xvrml_nodegen_test.cpp: runs the generator as a program and checks its output for small
// specifications, and where and how it refuses bad ones. tests/nodegen/update.sh makes the expected
// outputs. The first lines of a bad specification state the expected errors.
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace {

namespace fs = std::filesystem;

const fs::path folder = "tests/nodegen";

std::string readFile(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream) << path;
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeFile(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

struct Result {
  int code = -1;
  std::string output; // standard output and error
};

Result run(const std::string& command) {
  Result result;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return result;
  char buffer[4096];
  for (size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    result.output.append(buffer, n);
  const int status = pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

Result nodegen(const std::string& arguments) {
  return run(fmt::format("'{}' {}", NODEGEN_PROGRAM, arguments));
}

// A temporary folder for each test, removed at its end.
class Nodegen : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "nodegen-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    out = name;
  }
  void TearDown() override { fs::remove_all(out); }

  void expectGolden(const std::string& name) {
    const Result result =
        nodegen(fmt::format("{0} --output {1} --reference {1}/nodes.md --stub {1}/nodes.pyi",
                            (folder / (name + ".node")).string(), out.string()));
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_EQ(result.output, "");
    for (const fs::path file : {"xvrml/nodes.h", "xvrml/node_renderer.h", "nodes_list.cpp",
                                "nodes_renderer.cpp", "nodes.md", "nodes.pyi"})
      expectSame(name, file);
    expectSame(name, "nodes_" + name + ".cpp");
  }

  void expectSame(const std::string& name, const fs::path& file) {
    EXPECT_EQ(readFile(out / file),
              readFile(folder / "expected" / name / (file.filename().string() + ".expected")))
        << file;
  }

  fs::path out;
};

TEST_F(Nodegen, WritesEveryFieldType) { expectGolden("tiny"); }

TEST_F(Nodegen, AbstractTypesDescribeTheFieldsOfTheirNodes) { expectGolden("roles"); }

TEST_F(Nodegen, AComponentOfX3dSaysSo) { expectGolden("x3d"); }

TEST_F(Nodegen, WhatItWritesCompiles) {
  ASSERT_EQ(
      nodegen(
          fmt::format("{0}/tiny.node -o {1} --skeleton Everything --skeleton-file {1}/skeleton.cpp",
                      folder.string(), out.string()))
          .code,
      0);
  writeFile(out / "renderer.cpp", "#include \"xvrml/node_renderer.h\"\n");
  for (const char* file : {"nodes_tiny.cpp", "nodes_list.cpp", "skeleton.cpp", "renderer.cpp"}) {
    const Result result = run(fmt::format(
        "'{0}' -std=c++20 -fsyntax-only -Wall -Wextra "
        "-Wno-missing-field-initializers -Werror -I{1} -Ilibxvrml/include -Ilibxvrml {1}/{2}",
        NODEGEN_COMPILER, out.string(), file));
    EXPECT_EQ(result.code, 0) << result.output;
  }
}

TEST_F(Nodegen, ImportedFilesGiveAbstractTypesOnly) {
  writeFile(
      out / "mine.node",
      "component \"Mine\"\nPyramid : geometry { \"A pyramid.\" field SFFloat height 2 # (0,inf)\n"
      "  change geometry \"Height.\" }\n");
  const std::string specification = (out / "mine.node").string();
  EXPECT_EQ(nodegen(specification).code, 4); // the category geometry is not defined
  std::string imports;
  for (const auto& entry : fs::directory_iterator("libxvrml/nodes"))
    if (entry.path().extension() == ".node") imports += " --import " + entry.path().string();
  const Result result = nodegen(fmt::format("{} {} -o {}", imports, specification, out.string()));
  EXPECT_EQ(result.code, 0) << result.output;
  const std::string header = readFile(out / "xvrml/nodes.h");
  EXPECT_NE(header.find("struct Pyramid : Node {\n  static constexpr int typeIndex = 0;"),
            std::string::npos)
      << header;
  EXPECT_EQ(header.find("struct Box"), std::string::npos);
  EXPECT_FALSE(fs::exists(out / "nodes_geometry.cpp"));
}

constexpr const char* twoNodes =
    "component \"Mine\"\nabstract thing \"A thing.\"\n"
    "Early : thing { \"Added later, before the other.\" }\nLate : thing { \"The first.\" }\n";

TEST_F(Nodegen, AListKeepsTheNumbersOfNodes) {
  writeFile(out / "mine.node", twoNodes);
  writeFile(out / "numbers.txt", "# a remark\n0 Late\n1 Early\n");
  const Result result =
      nodegen(fmt::format("{0}/mine.node --numbers {0}/numbers.txt -o {0}", out.string()));
  EXPECT_EQ(result.code, 0) << result.output;
  const std::string header = readFile(out / "xvrml/nodes.h");
  const auto holds = [](const std::string& text, const char* part) {
    return text.find(part) != text.npos;
  };
  EXPECT_TRUE(holds(header, "struct Late : Node {\n  static constexpr int typeIndex = 0;"))
      << header;
  EXPECT_TRUE(holds(header, "struct Early : Node {\n  static constexpr int typeIndex = 1;"));
  const std::string list = readFile(out / "nodes_list.cpp");
  EXPECT_LT(list.find("&Late::"), list.find("&Early::")) << list;
}

TEST_F(Nodegen, APluginHasCallbacksOfItsOwn) {
  writeFile(out / "mine.node", twoNodes);
  const Result result = nodegen(fmt::format("{0}/mine.node --plugin mine -o {0}", out.string()));
  EXPECT_EQ(result.code, 0) << result.output;
  const std::string header = readFile(out / "mine_nodes.h");
  EXPECT_NE(header.find("class MineRenderer {"), std::string::npos) << header;
  EXPECT_NE(header.find("virtual Visit renderLate(nodes::Late& /*node*/, const RenderState& "
                        "/*state*/) { return Visit::children; }"),
            std::string::npos)
      << header;
  const std::string tables = readFile(out / "nodes_mine.cpp");
  EXPECT_NE(tables.find("dynamic_cast<MineRenderer*>(&renderer)"), std::string::npos) << tables;
  EXPECT_FALSE(fs::exists(out / "xvrml/node_renderer.h"));
}

TEST_F(Nodegen, AListThatContradictsTheNodesIsRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"0 Late\n", "mine.node:3:1: error: Early has no number: append \"1 Early\" to numbers.txt"},
      {"0 Late\n2 Early\n", "numbers.txt:2:1: error: number 1 was expected, not \"2\""},
      {"0 Late\n0 Early\n", "numbers.txt:2:1: error: number 1 was expected, not \"0\""},
      {"0 Late\n1 Early\n2 Late\n", "numbers.txt:3:1: error: Late has number 0 already"},
      {"0 Late\n1 Gone\n2 Early\n", "numbers.txt:2:1: error: there is no node \"Gone\""},
      {"Late\n", "numbers.txt:1:1: error: number 0 was expected, not \"Late\""},
      {"0\n", "numbers.txt:1:1: error: there is no node \"\""},
  };
  writeFile(out / "mine.node", twoNodes);
  for (const auto& [list, message] : cases) {
    writeFile(out / "numbers.txt", list);
    const Result result = run(fmt::format("cd {} && '{}' mine.node --numbers numbers.txt -o code",
                                          out.string(), NODEGEN_PROGRAM));
    EXPECT_EQ(result.code, 4) << list;
    EXPECT_NE(result.output.find(message), std::string::npos) << result.output;
    EXPECT_FALSE(fs::exists(out / "code")) << list;
  }
  EXPECT_EQ(nodegen(fmt::format("{0}/mine.node --numbers {0}/none.txt", out.string())).code, 3);
  EXPECT_EQ(
      nodegen(fmt::format("{0}/mine.node --numbers {0}/numbers.txt --plugin mine", out.string()))
          .code,
      2);
}

TEST_F(Nodegen, ASkeletonIsWrittenOnce) {
  const std::string file = (out / "skeleton.cpp").string();
  const std::string arguments =
      fmt::format("{}/tiny.node --skeleton Everything --skeleton-file {}", folder.string(), file);
  EXPECT_EQ(nodegen(arguments).code, 0);
  EXPECT_EQ(readFile(file), readFile(folder / "expected/tiny/skeleton.cpp.expected"));
  writeFile(file, "mine");
  const Result again = nodegen(arguments);
  EXPECT_EQ(again.code, 5);
  EXPECT_NE(again.output.find("skeleton.cpp exists"), std::string::npos) << again.output;
  EXPECT_EQ(readFile(file), "mine");
}

TEST_F(Nodegen, WrongUseAndMissingFilesHaveExitCodesOfTheirOwn) {
  EXPECT_EQ(nodegen("--help").code, 0);
  EXPECT_NE(nodegen("--help").output.find("--skeleton"), std::string::npos);
  EXPECT_EQ(nodegen("").code, 2);
  EXPECT_EQ(nodegen("--nonsense x.node").code, 2);
  EXPECT_EQ(nodegen(fmt::format("{}/tiny.node --skeleton Nothing", folder.string())).code, 2);
  const Result missing = nodegen((out / "missing.node").string());
  EXPECT_EQ(missing.code, 3);
  EXPECT_NE(missing.output.find("cannot read"), std::string::npos) << missing.output;
  EXPECT_EQ(nodegen(out.string()).code, 3); // the output file is a folder
  writeFile(out / "file", "");
  EXPECT_EQ(
      nodegen(fmt::format("{}/tiny.node -o {}/file/folder", folder.string(), out.string())).code,
      5);
}

TEST_F(Nodegen, NothingIsWrittenFromABadSpecification) {
  EXPECT_EQ(
      nodegen(fmt::format("{}/bad/many-errors.node -o {}/code", folder.string(), out.string()))
          .code,
      4);
  EXPECT_FALSE(fs::exists(out / "code"));
}

std::vector<std::string> badSpecifications() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(BAD_SPECIFICATIONS)))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class BadSpecification : public testing::TestWithParam<std::string> {};

// The lines `# expect line:column: error: message` list all errors in their order.
TEST_P(BadSpecification, IsRefusedAtItsLine) {
  const std::string file = GetParam() + ".node";
  std::istringstream specification(readFile(folder / "bad" / file));
  std::string expected, reported;
  for (std::string line; std::getline(specification, line);)
    if (line.starts_with("# expect ")) expected += file + ':' + line.substr(9) + '\n';
  const Result result =
      run(fmt::format("cd {}/bad && '{}' {}", folder.string(), NODEGEN_PROGRAM, file));
  std::istringstream output(result.output);
  for (std::string line; std::getline(output, line);)
    if (line.find(": error: ") != std::string::npos) reported += line + '\n';
  EXPECT_NE(expected, "");
  EXPECT_EQ(reported, expected);
  EXPECT_EQ(result.code, 4);
}

std::string caseName(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Nodegen, BadSpecification, testing::ValuesIn(badSpecifications()),
                         caseName);

} // namespace
