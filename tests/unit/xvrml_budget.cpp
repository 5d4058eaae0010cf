// xvrml_budget.cpp: the memory budget of a world (limit worldBytes): what nodes, values, prototypes
// and scripts charge to it, what happens when it is exhausted, and that memory is returned.
#include <fmt/format.h>
#include <zlib.h>

#include "base/budget.h"
#include "unit/xvrml_parser_support.h"
#include "xvrml/browser.h"

namespace {

using namespace parser_test;

LoadOptions of(uint64_t bytes) {
  LoadOptions options;
  options.limits.worldBytes = bytes;
  return options;
}

std::string repeated(const std::string& text, size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (size_t i = 0; i < count; ++i) all += text;
  return all;
}

std::string gzipped(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = uInt(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = uInt(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// Checks that the budget refused something once, with a message that names it.
void expectRefused(const World& world, uint64_t limit) {
  const std::string name = fmt::format("limit worldBytes={}", limit);
  EXPECT_EQ(count(messages(world), name), 1u) << messages(world);
  EXPECT_LE(budgetOf(world)->used(), limit);
}

TEST(Budget, TakesAndGives) {
  Budget budget(100);
  EXPECT_TRUE(budget.take(60));
  EXPECT_FALSE(budget.take(41));
  EXPECT_EQ(budget.used(), 60u);
  EXPECT_FALSE(budget.take(~uint64_t(0)));
  EXPECT_TRUE(budget.take(40));
  EXPECT_EQ(budget.left(), 0u);
  budget.give(100);
  EXPECT_EQ(budget.left(), 100u);
  EXPECT_EQ(budget.name(), "limit worldBytes=100");
}

TEST(Budget, SharesComeBackByThemselves) {
  const auto budget = std::make_shared<Budget>(100);
  {
    Share one(budget), two(budget);
    EXPECT_TRUE(one.take(50));
    EXPECT_TRUE(two.take(50));
    EXPECT_FALSE(one.take(1));
    Share moved(std::move(one));
    EXPECT_EQ(budget->used(), 100u);
    moved = Share(budget);
    EXPECT_EQ(budget->used(), 50u);
  }
  EXPECT_EQ(budget->used(), 0u);
}

TEST(Budget, TheDefaultIsOfTheMachine) {
  const Budget budget(0);
  EXPECT_EQ(budget.limit(), defaultWorldBytes());
  EXPECT_GE(budget.limit(), 256u << 20);
  EXPECT_EQ(budgetOf(*parse("Shape { }"))->limit(), defaultWorldBytes());
  LoadOptions options;
  EXPECT_TRUE(setLimit(options.limits, "worldBytes", 1'000'000));
  EXPECT_EQ(budgetOf(*parse("Shape { }", options))->limit(), 1'000'000u);
}

TEST(Budget, OfNodes) {
  const auto world = parse(repeated("PointLight { }\n", 1000), of(60'000));
  expectRefused(*world, 60'000);
  EXPECT_EQ(world->scope.roots.size(), 200u);
  EXPECT_EQ(messages(*parse(repeated("PointLight { }\n", 1000), of(1'000'000))), "");
}

TEST(Budget, OfStrings) {
  const std::string many = "WorldInfo { info [" + repeated("\"a\" ", 10'000) + "] }";
  expectRefused(*parse(many, of(100'000)), 100'000);
  EXPECT_EQ(messages(*parse(many, of(1'000'000))), "");
  const std::string longOne = "WorldInfo { title \"" + std::string(200'000, 'x') + "\" }";
  expectRefused(*parse(longOne, of(100'000)), 100'000);
  EXPECT_EQ(messages(*parse(longOne, of(1'000'000))), "");
}

TEST(Budget, OfNumbersAndPixels) {
  const std::string points = "Shape { geometry PointSet { coord Coordinate { point [" +
                             repeated("0 0 0 ", 10'000) + "] } } }";
  expectRefused(*parse(points, of(100'000)), 100'000);
  EXPECT_EQ(messages(*parse(points, of(1'000'000))), "");
  expectRefused(*parse("PixelTexture { image 20000 10000 4 0 }",
                       [] {
                         LoadOptions options = of(1'000'000);
                         options.limits.imagePixels = ~uint64_t(0);
                         return options;
                       }()),
                1'000'000);
}

TEST(Budget, OfPrototypesAndTheirFields) {
  std::string fields;
  for (int i = 0; i < 100; ++i) fields += fmt::format("field SFInt32 f{} 0 ", i);
  const std::string text = "PROTO P [ " + fields + "] { Group { } }\n";
  const auto world = parse(text + repeated("P { }\n", 1000), of(1'000'000)); // at least 4 kB each
  EXPECT_GE(count(messages(*world), "limit worldBytes=1000000"), 1u) << messages(*world);
  EXPECT_LE(world->nodeCount, 500u);
  EXPECT_EQ(messages(*parse(text + repeated("P { }\n", 10), of(1'000'000))), "");
}

// One list of numbers used by many nodes.
TEST(Budget, OfValuesThatPrototypesCopy) {
  const std::string body = repeated("ScalarInterpolator { key IS k }\n", 200);
  const std::string text = "PROTO P [ field MFFloat k [ ] ] { Group { } " + body + "}\nP { k [" +
                           repeated("1 ", 10'000) + "] }";
  expectRefused(*parse(text, of(2'000'000)), 2'000'000);
  EXPECT_EQ(messages(*parse(text, of(40'000'000))), "");
}

TEST(Budget, OfRoutesAndNames) {
  std::string text = "DEF A TimeSensor { } DEF B ScalarInterpolator { }\n";
  text += repeated("ROUTE A.fraction_changed TO B.set_fraction\n", 10'000);
  expectRefused(*parse(text, of(100'000)), 100'000);
}

TEST(Budget, ComesBackWithTheWorld) {
  BudgetPtr budget;
  {
    const auto world = parse(repeated("Shape { }\n", 100), of(1'000'000));
    budget = budgetOf(*world);
    EXPECT_GT(budget->used(), 10'000u);
  }
  EXPECT_EQ(budget.use_count(), 1); // the world has released it
}

// Unpacked text counts only while the file is read.
TEST(Budget, OfTextThatIsUnpacked) {
  const std::string header = "#VRML V2.0 utf8\n", comment = "#" + std::string(600'000, 'x') + "\n";
  const std::string nodes = repeated("PointLight { }\n", 2000); // 600,000 bytes of nodes
  const auto load = [](const std::string& text) {
    return loadWorldFromMemory(text, "test.wrl", of(1'000'000));
  };
  // This text is owned by the caller, so it is not counted.
  EXPECT_EQ(messages(*load(header + comment + nodes)), "");
  EXPECT_EQ(messages(*load(gzipped(header + nodes))), "");
  const auto world = load(gzipped(header + comment + nodes));
  expectRefused(*world, 1'000'000);
  EXPECT_LT(budgetOf(*world)->used(), 400'000u); // the unpacked text has been released
  try {
    load(gzipped(header + comment + comment));
    ADD_FAILURE() << "a text of more bytes than the budget was unpacked";
  } catch (const LoadError& error) {
    EXPECT_NE(error.diagnostic.text().find("limit worldBytes=1000000"), std::string::npos)
        << error.diagnostic.text();
  }
}

// Objects that programs create and drop for hours do not add up.
TEST(Budget, OfWhatProgramsMakeIsChecked) {
  Browser browser(parse("Group { }", of(1'000'000)));
  const std::string some = repeated("Shape { }\n", 1000);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(browser.createVrmlFromString(some).size(), 1000u) << i;
  EXPECT_LT(browser.createVrmlFromString(repeated("Shape { }\n", 10'000)).size(), 4000u);
  EXPECT_TRUE(says(browser.world(), "limit worldBytes=1000000"));
}

TEST(Budget, OneInterfaceIsToldOnce) {
  std::string fields;
  for (int i = 0; i < 30'000; ++i) fields += fmt::format("field SFInt32 f{} 0 ", i);
  const auto world = parse("PROTO P [ " + fields + "] { Group { } } P { }");
  EXPECT_EQ(count(messages(*world), "limit interfaceFields=10000"), 1u);
}

} // namespace
