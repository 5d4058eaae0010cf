// inlines.cpp: Inlines of a running world: clause 6.25, and 4.6.10 for the bindable nodes in them.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "conformance/events/scripted.h"
#include "conformance/events/viewing.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// A temporary folder with some files, for one test.
struct Folder {
  Folder()
      : path(std::filesystem::temp_directory_path() /
             fmt::format("xvrml_inlines_{}_{}", ::getpid(),
                         testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name, const std::string& vrml) const {
    std::ofstream(path / name) << "#VRML V2.0 utf8\n" << vrml;
    return (path / name).string();
  }
  std::filesystem::path path;
};

TEST(Inlines, BindablesInThemAreNotTheFirst) {
  const Folder f;
  f.file("in.wrl", "DEF INNER Viewpoint { position 1 0 0 } Background {}");
  Browser browser(
      loadWorld(f.file("a.wrl", "Inline { url \"in.wrl\" } Transform { translation 5 0 0 children "
                                "Inline { url \"in.wrl\" } } DEF V Viewpoint {}")));
  EXPECT_EQ(nameOf(browser.bound().viewpoint), "V");
  EXPECT_EQ(browser.bound().background, nullptr);
}

TEST(Inlines, BindablesInThemCanBeBoundAndAreListed) {
  const Folder f;
  f.file("in.wrl", "DEF INNER Viewpoint { position 1 0 0 description \"inside\" }");
  Browser browser(loadWorld(f.file(
      "a.wrl",
      "DEF V Viewpoint {} Transform { translation 5 0 0 children Inline { url \"in.wrl\" } }")));
  ASSERT_EQ(browser.viewpoints().size(), 2u);
  EXPECT_EQ(browser.viewpoints()[1].description, "inside");
  EXPECT_TRUE(browser.bindViewpoint("inside"));
  EXPECT_EQ(eyeOf(browser), "6 0 0");
}

TEST(Inlines, SetUrlLoadsOtherContentAndTheOldLeaves) {
  const Folder f;
  f.file("one.wrl", "DEF INNER Viewpoint { position 1 0 0 } DEF T TimeSensor { loop TRUE } DEF P "
                    "PositionInterpolator {}"
                    "ROUTE T.fraction_changed TO P.set_fraction");
  f.file("two.wrl", "Shape { geometry Box {} }");
  Browser browser(loadWorld(
      f.file("a.wrl", "DEF V Viewpoint { position 0 0 7 } DEF I Inline { url \"one.wrl\" }")));
  ASSERT_EQ(browser.viewpoints().size(), 2u);
  EXPECT_TRUE(browser.set(*browser.viewpoints()[1].node, "set_bind", true));
  EXPECT_EQ(eyeOf(browser), "1 0 0");
  const double origin[3] = {0, 0, 5}, direction[3] = {0, 0, -1};
  PickHit hit;
  EXPECT_FALSE(browser.pick(origin, direction, {}, hit));
  browser.takeChanges();
  EXPECT_TRUE(browser.set(*browser.node("I"), "url", MFString{"two.wrl"}));
  EXPECT_EQ(nameOf(browser.bound().viewpoint), "V");
  EXPECT_EQ(eyeOf(browser), "0 0 7");
  EXPECT_TRUE(browser.pick(origin, direction, {}, hit));
  bool told = false;
  for (const FieldChange& change : browser.takeChanges())
    told |= change.field && change.field->name == "url";
  EXPECT_TRUE(told);
  browser.tick(1);
}

TEST(Inlines, RoutesAndSensorsOfLateContentRun) {
  const Folder f;
  f.file("in.wrl", "DEF S ProximitySensor { size 99 99 99 } DEF T Transform { children Shape { "
                   "geometry Box {} } } ROUTE S.position_changed TO T.translation");
  Browser browser(loadWorld(f.file("a.wrl", "DEF I Inline {}")));
  browser.tick(1);
  browser.set(*browser.node("I"), "url", MFString{"nothing.wrl", "in.wrl"});
  browser.tick(2);
  const double origin[3] = {0, 0, 50}, direction[3] = {0, 0, -1};
  PickHit hit;
  ASSERT_TRUE(browser.pick(origin, direction, {}, hit));
  EXPECT_EQ(hit.point[2], 11);
}

TEST(Inlines, WhatCannotBeReadIsSaidAndLeavesItEmpty) {
  const Folder f;
  f.file("one.wrl", "Shape { geometry Box {} }");
  Browser browser(loadWorld(f.file("a.wrl", "DEF I Inline { url \"one.wrl\" }")));
  browser.set(*browser.node("I"), "url", MFString{"missing.wrl"});
  EXPECT_EQ(browser.world().diagnostics.warnings(), 1u);
  EXPECT_EQ(inlineScope(*browser.node("I")), nullptr);
}

TEST(Inlines, OnDemandTheyAreLoadedWhenAsked) {
  const Folder f;
  f.file("inner.wrl", "DEF INNER Viewpoint {}");
  f.file("in.wrl", "Group { children Inline { url \"inner.wrl\" } }");
  LoadOptions options;
  options.loadInlines = false;
  Browser browser(loadWorld(
      f.file("a.wrl", "DEF I Inline { url \"in.wrl\" } Inline { url \"inner.wrl\" } Inline {}"),
      options));
  EXPECT_EQ(inlineScope(*browser.node("I")), nullptr);
  EXPECT_TRUE(browser.loadInline(*browser.node("I")));
  EXPECT_EQ(browser.viewpoints().size(), 0u);
  EXPECT_EQ(browser.loadInlines(), 2u);
  EXPECT_EQ(browser.viewpoints().size(), 2u);
  EXPECT_EQ(browser.loadInlines(), 0u);
}

TEST(Inlines, NoneIsReadIntoItself) {
  const Folder f;
  f.file("in.wrl", "Group { children Inline { url \"a.wrl\" } }");
  LoadOptions options;
  options.loadInlines = false;
  Browser browser(loadWorld(f.file("a.wrl", "DEF I Inline { url \"in.wrl\" }"), options));
  EXPECT_EQ(browser.loadInlines(), 1u);
  EXPECT_EQ(browser.world().diagnostics.errors(), 1u);
  browser.set(*browser.node("I"), "url", MFString{"a.wrl"});
  EXPECT_EQ(inlineScope(*browser.node("I")), nullptr);
}

// 4.5.3: such URLs are relative to the file that contains the program.
TEST(CreatedNodes, UrlsCountFromTheFileOfTheProgram) {
  const Folder f;
  std::filesystem::create_directories(f.path / "lib");
  std::ofstream(f.path / "lib/s.test") << "initialize: create out Anchor { url \"a.png\" }\n";
  const std::string route = " eventOut MFNode out } ROUTE S.out TO G.addChildren";
  f.file("lib/in.wrl",
         "DEF G Group {} DEF S Script { url \"test:initialize: create out Anchor { url "
         "\\\"a.png\\\" }\"" +
             route);
  Browser browser(
      loadWorld(f.file("a.wrl", "DEF I Inline { url \"lib/in.wrl\" } DEF G Group {} DEF "
                                "S Script { url \"lib/s.test\"" +
                                    route)),
      scriptOptions());
  const auto folderOf = [](const Node& group) {
    const auto& children = dynamic_cast<const nodes::Group&>(group).children;
    if (children.size() != 1) return std::string("no node");
    const std::string path = resolveUrl("a.png", *children[0]->source.file, {}).path;
    return std::filesystem::path(path).parent_path().filename().string();
  };
  EXPECT_EQ(folderOf(*browser.node("G")), "lib");
  const Scope* content = inlineScope(*browser.node("I"));
  ASSERT_NE(content, nullptr);
  EXPECT_EQ(folderOf(*content->names.at("G")), "lib");
}

// A file that a Script creates out of itself ends at the depth of Inlines.
TEST(CreatedNodes, FilesWithinFilesEndAtTheLimit) {
  const Folder f;
  LoadOptions options;
  for (const uint64_t most : {4, 5, 32}) {
    options.limits.inlineDepth = most;
    const std::string path =
        f.file("a.wrl", "DEF G Group {} DEF S Script { eventOut MFNode out url \"test:initialize: "
                        "create out Inline { url \\\"a.wrl\\\" }\" } ROUTE S.out TO G.addChildren");
    Browser browser(loadWorld(path, options), scriptOptions());
    const auto& list = browser.world().diagnostics.list();
    ASSERT_EQ(list.size(), 1u) << most;
    EXPECT_NE(list[0].message.find(fmt::format("limit inlineDepth={}", most)), std::string::npos)
        << list[0].message;
  }
}

// Other files that are loaded into a running world.
TEST(OtherFiles, BindablesOfCreateVrmlFromUrlAreNotBoundByThemselves) {
  const Folder f;
  f.file("more.wrl", "DEF M Viewpoint { position 0 0 3 description \"more\" }");
  Browser browser(loadWorld(f.file("a.wrl", "DEF G Group {}")));
  browser.createVrmlFromUrl({"missing.wrl", "more.wrl"}, *browser.node("G"), "addChildren");
  ASSERT_EQ(browser.viewpoints().size(), 1u);
  EXPECT_EQ(browser.bound().viewpoint, nullptr);
  EXPECT_TRUE(browser.bindViewpoint("more"));
  EXPECT_EQ(eyeOf(browser), "0 0 3");
}

TEST(OtherFiles, AClickOnAnAnchorLoadsItsWorldAndBindsTheViewpointNamed) {
  const Folder f;
  f.file("b.wrl", "DEF FIRST Viewpoint { position 0 0 3 } DEF SECOND Viewpoint { position 0 0 4 } "
                  "Shape { geometry Sphere {} }");
  Browser browser(loadWorld(f.file(
      "a.wrl",
      "DEF V Viewpoint {} Anchor { url \"b.wrl#SECOND\" children Shape { geometry Box {} } }")));
  const uint64_t generation = browser.generation();
  browser.pointer(0, 0, true);
  browser.pointer(0, 0, false);
  EXPECT_EQ(browser.generation(), generation + 1);
  EXPECT_EQ(nameOf(browser.bound().viewpoint), "SECOND");
  EXPECT_TRUE(browser.sensorsAtPointer().empty());
  const double origin[3] = {0.9, 0.9, 5}, direction[3] = {0, 0, -1};
  PickHit hit;
  EXPECT_FALSE(browser.pick(origin, direction, {}, hit)); // the box has been removed
  browser.tick(1);
}

} // namespace
} // namespace xvrml
