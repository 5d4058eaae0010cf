// editor_library.cpp: Tests what comes into a world from other files: materials of the user's
// folder, and Inlines; and sensors that are made of probes.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "edit/import.h"
#include "edit/kept_probes.h"
#include "edit/look_library.h"
#include "edit/material_files.h"
#include "unit/editor_support.h"
#include "xvrml/nodes.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;
namespace fs = std::filesystem;

constexpr const char* hall = "#VRML V2.0 utf8\n"
                             "DEF A Shape { # by hand\n"
                             "  appearance DEF PAINT Appearance { material Material { } }\n"
                             "  geometry Box { }\n"
                             "}\n"
                             "DEF B Shape { appearance USE PAINT geometry Sphere { } }\n"
                             "DEF leg Group { }\n";

constexpr const char* oak = "#VRML V2.0 utf8\n"
                            "Viewpoint { }\n"
                            "Transform { children Shape {\n"
                            "  appearance Appearance {\n"
                            "    material DEF WOOD Material { diffuseColor .5 .3 .1 }\n"
                            "    texture DEF GRAIN ImageTexture { url \"oak.png\" repeatS FALSE }\n"
                            "    textureTransform TextureTransform { scale 2 2 }\n"
                            "  }\n"
                            "  geometry Sphere { } } }\n"
                            "Shape { appearance Appearance { } }\n";

// A world in a folder, and other files beside it.
struct Library : testing::Test {
  Library() {
    fs::remove_all(folder);
    write("home/hall.wrl", hall);
  }
  ~Library() override { fs::remove_all(folder); }

  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = folder + name;
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  // Opens another world instead.
  void open(const std::string& path) {
    editor.reset();
    browser = std::make_unique<Browser>(loadWorld(path));
    editor = std::make_unique<WorldEditor>(*browser);
  }
  void select(std::initializer_list<const char*> names) {
    MFNode nodes;
    for (const char* name : names) nodes.push_back(browser->node(name));
    editor->select(nodes);
  }
  std::string text() { return editor->editor().text(); }
  bool has(const std::string& part) { return text().find(part) != std::string::npos; }
  void SetUp() override { open(folder + "home/hall.wrl"); }

  const std::string folder = testing::TempDir() + "editor_library_" +
                             testing::UnitTest::GetInstance()->current_test_info()->name() + "/";
  std::unique_ptr<Browser> browser;
  std::unique_ptr<WorldEditor> editor;
};

// --- Materials of the user ---

TEST_F(Library, FilesOfTheFolderAreLooks) {
  write("materials/oak.wrl", oak);
  write("materials/B rass.X3D", "");
  write("materials/oak.png", "");
  fs::create_directories(folder + "materials/folder.wrl");
  const std::vector<Look> looks = looksIn(folder + "materials");
  ASSERT_EQ(looks.size(), 2u);
  EXPECT_EQ(looks[0].name, "B rass");
  EXPECT_EQ(looks[1].name, "oak");
  EXPECT_FALSE(looks[1].isShader());
  EXPECT_TRUE(looksIn(folder + "nowhere").empty());
  EXPECT_TRUE(looksIn("").empty());
  ::setenv("XDG_DATA_HOME", folder.c_str(), 1);
  EXPECT_EQ(materialFolder(), folder + "xvrml/materials");
  ::setenv("XDG_DATA_HOME", "relative", 1);
  EXPECT_NE(materialFolder().rfind("relative", 0), 0u);
  ::unsetenv("XDG_DATA_HOME");
}

TEST_F(Library, AMaterialIsCopiedAsAWhole) {
  write("materials/oak.png", "");
  const Look look{"oak", "", "", write("materials/oak.wrl", oak)};
  select({"A"});
  setLook(*editor, look, false);
  EXPECT_EQ(editor->editor().undoName(), "Set look oak");
  EXPECT_TRUE(has("DEF A Shape { # by hand\n  appearance DEF PAINT Appearance {")) << text();
  EXPECT_TRUE(has("DEF B Shape { appearance USE PAINT")) << text();
  EXPECT_TRUE(has("material Material { diffuseColor 0.5 0.3 0.1 }")) << text();
  EXPECT_TRUE(has("url [ \"../materials/oak.png\" ]") && has("repeatS FALSE")) << text();
  EXPECT_TRUE(has("textureTransform TextureTransform { scale 2 2 }")) << text();
  const ResolvedUrl picture = resolveUrl("../materials/oak.png", browser->world().path, {});
  EXPECT_TRUE(fs::equivalent(picture.path, folder + "materials/oak.png"));
  editor->undo();
  EXPECT_EQ(text(), hall);
}

TEST_F(Library, AMaterialOnlyHere) {
  const Look look{"oak", "", "", write("materials/oak.wrl", oak)};
  select({"B"});
  setLook(*editor, look, true);
  EXPECT_TRUE(has("appearance DEF PAINT Appearance { material Material { } }")) << text();
  EXPECT_TRUE(has("diffuseColor 0.5 0.3 0.1")) << text();
  EXPECT_EQ(browser->node("A")->type().name, "Shape");
  EXPECT_NE(lookOf(*browser->node("A")).appearance, lookOf(*browser->node("B")).appearance);
  editor->undo();
  EXPECT_EQ(text(), hall);
}

TEST_F(Library, AShaderComesWithItsDeclaredFields) {
  const std::string glass =
      "#VRML V2.0 utf8\nShape { appearance ORTAppearance { shader ORTShader {\n"
      "  exposedField SFFloat index 1.4 name \"Glass\" file \"glass\" } } }\n";
  const Look look{"glass", "", "", write("materials/glass.wrl", glass)};
  select({"A"});
  setLook(*editor, look, false);
  EXPECT_TRUE(has("DEF PAINT ORTAppearance")) << text();
  EXPECT_TRUE(has("exposedField SFFloat index 1.4")) << text();
  EXPECT_TRUE(has("name \"Glass\"")) << text();
  editor->undo();
  EXPECT_EQ(text(), hall);
}

TEST_F(Library, AMaterialGoesIntoEachEncoding) {
  const Look look{"oak", "", "", write("materials/oak.wrl", oak)};
  open(write("home/hall.x3d", "<X3D profile='Immersive' version='4.0'>\n<Scene>\n"
                              "<Shape DEF='A'><Box/></Shape>\n</Scene>\n</X3D>\n"));
  select({"A"});
  setLook(*editor, look, false);
  EXPECT_TRUE(has("<Material diffuseColor='0.5 0.3 0.1'")) << text();
  EXPECT_TRUE(has("../materials/oak.png")) << text();
  open(write("home/hall.x3dj", "{\"X3D\": {\"@version\": \"4.0\", \"Scene\": {\"-children\": [\n"
                               "{\"Shape\": {\"@DEF\": \"A\", \"-geometry\": {\"Box\": {}}}}\n"
                               "]}}}\n"));
  select({"A"});
  setLook(*editor, look, false);
  EXPECT_TRUE(has("\"@diffuseColor\"") && has("../materials/oak.png")) << text();
}

TEST_F(Library, WhatIsNoMaterialIsRefused) {
  select({"A"});
  const auto refuses = [&](const std::string& name, const std::string& content,
                           const std::string& why) {
    const Look look{"x", "", "", content.empty() ? folder + name : write(name, content)};
    try {
      setLook(*editor, look, false);
      ADD_FAILURE() << name;
    } catch (const EditError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
    EXPECT_EQ(text(), hall);
  };
  refuses("m/none.wrl", "#VRML V2.0 utf8\nShape { }\n", "no Appearance");
  refuses("m/gone.wrl", "", "gone.wrl");
  refuses("m/noise.wrl", "noise", "noise.wrl");
  refuses("m/proto.wrl",
          "#VRML V2.0 utf8\nPROTO P [ ] { Material { } }\n"
          "Shape { appearance Appearance { material P { } } }\n",
          "declared in its own file");
}

// --- Balls ---

TEST_F(Library, BallsAreRenderedOneAfterTheOther) {
  ::setenv("XDG_DATA_HOME", folder.c_str(), 1);
  write("xvrml/materials/oak.wrl", oak);
  write("xvrml/materials/noise.wrl", "noise");
  LookLibrary library;
  library.refresh();
  ASSERT_EQ(library.own().size(), 2u);
  const std::vector<Look> installed = {{"Material", "", ""}, {"Glass", "glass", ""}};
  const auto advance = [&] {
    while (!library.advance(installed, "", true)) std::this_thread::yield();
  };
  EXPECT_FALSE(library.advance(installed, "", false));
  advance(); // the file that cannot be read has none, which is an answer
  EXPECT_EQ(library.ballOf(library.own()[0]), nullptr);
  for (int i = 0; i < 3; ++i) advance();
  EXPECT_FALSE(library.advance(installed, "", true)) << "each is rendered once";
  const LookBall* const wood = library.ballOf(library.own()[1]);
  const LookBall* const glass = library.ballOf(installed[1]);
  ASSERT_TRUE(wood && glass && library.ballOf(installed[0]));
  ASSERT_EQ(wood->rgb.size(), size_t(3 * LookBall::side * LookBall::side));
  EXPECT_NE(wood->rgb, glass->rgb);
  const uint8_t* const middle =
      &wood->rgb[3 * (LookBall::side * LookBall::side / 2 + LookBall::side / 2)];
  EXPECT_GT(int(middle[0]), int(middle[2])) << "it is brown";
  const uint64_t number = wood->number;
  write("xvrml/materials/oak.wrl", std::string(oak) + "# mended\n");
  fs::last_write_time(library.own()[1].file,
                      fs::file_time_type::clock::now() + std::chrono::seconds(5));
  library.refresh();
  EXPECT_EQ(library.ballOf(library.own()[1]), nullptr);
  advance();
  ASSERT_TRUE(library.ballOf(library.own()[1]));
  EXPECT_NE(library.ballOf(library.own()[1])->number, number);
  ::unsetenv("XDG_DATA_HOME");
}

TEST_F(Library, ABallGivesWay) {
  LookLibrary library;
  const std::vector<Look> installed = {{"Material", "", ""}};
  EXPECT_FALSE(library.advance(installed, "", true)); // begins
  EXPECT_FALSE(library.advance(installed, "", false));
  while (!library.advance(installed, "", true)) std::this_thread::yield();
  EXPECT_TRUE(library.ballOf(installed[0]));
}

// --- Other files ---

TEST_F(Library, AFileIsImportedAsAnInline) {
  const std::string other = "#VRML V2.0 utf8\nShape { geometry Cone { } }\n";
  importFile(*editor, write("meshes of mine/leg.wrl", other));
  EXPECT_TRUE(
      has("DEF leg Group { }\nDEF leg_2 Inline { url [ \"../meshes%20of%20mine/leg.wrl\" ] }"))
      << text();
  EXPECT_EQ(editor->editor().undoName(), "Import leg_2");
  ASSERT_TRUE(editor->selected());
  ASSERT_TRUE(inlineScope(*editor->selected()));
  EXPECT_EQ(inlineScope(*editor->selected())->roots.size(), 1u);
  editor->undo();
  EXPECT_EQ(text(), hall);
  select({"leg"});
  write("home/7 up#.wrl", other);
  importFile(*editor, "7 up#.wrl");
  EXPECT_TRUE(
      has("DEF leg Group { children [\n  DEF _7_up_ Inline { url [ \"7%20up%23.wrl\" ] }\n] }"))
      << text();
  editor->undo();
  EXPECT_EQ(text(), hall);
}

TEST_F(Library, AMeshIsImported) {
  importFile(*editor, write("home/part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_TRUE(has("DEF part Inline { url [ \"part.obj\" ] }")) << text();
  EXPECT_TRUE(inlineScope(*browser->node("part")));
}

TEST_F(Library, WhatCannotBeImportedIsRefused) {
  const auto refuses = [&](const std::string& file, const std::string& why) {
    try {
      importFile(*editor, file);
      ADD_FAILURE() << file;
    } catch (const EditError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
    EXPECT_EQ(editor->editor().undoName(), "");
    EXPECT_EQ(browser->world().scope.roots.size(), 3u);
  };
  refuses(folder + "gone.wrl", "there is no file");
  refuses(folder, "there is no file");
  refuses("hall.wrl", "part of itself");
  refuses(write("home/noise.txt", "noise"), "is not imported: ");
}

TEST_F(Library, AReadOnlyWorldTakesNothing) {
  open(write("home/part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_THROW(importFile(*editor, folder + "home/hall.wrl"), EditError);
  EditModel model;
  model.update(*editor, front(), false, 0);
  EXPECT_NE(model.readOnly().find("can be edited in place"), std::string::npos);
  EXPECT_EQ(model.unwritable(), "");
}

// --- Sensors ---

TEST_F(Library, AProbeIsKeptAsASensor) {
  const double point[3] = {1, 0.5, 0}, normal[3] = {0, 0, -1}, seen[3] = {0, 0, -1};
  Probes probes;
  probes.addSensor(picture::sensorAt(point, normal, seen));
  keepInWorld(*editor, probes.all()[0], front());
  EXPECT_TRUE(has("DEF leg Group { }\nORTSensor {")) << text();
  EXPECT_EQ(editor->editor().undoName(), "Keep probe 1");
  const auto* const sensor = nodeCast<nodes::ORTSensor>(editor->selected());
  ASSERT_TRUE(sensor);
  EXPECT_EQ(sensor->position, (Vec3f{1, 0.5f, 0}));
  EXPECT_EQ(sensor->direction, (Vec3f{0, 0, 1}));
  EXPECT_EQ(sensor->quantity, "ILLUMINANCE");
  EXPECT_EQ(sensor->description, "probe 1");
  EXPECT_THROW(keepInWorld(*editor, probes.all()[0], front()), EditError) << "it is there";
  editor->undo();
  EXPECT_EQ(text(), hall);
  probes.rename(1, "Desk");
  keepInWorld(*editor, probes.all()[0], front());
  EXPECT_TRUE(has("description \"Desk\"")) << text();
  Probes shown;
  showSensors(*editor, shown);
  EXPECT_EQ(titleOf(shown.all().at(0)), "1 Desk");
}

TEST_F(Library, SensorsAreShownAsProbes) {
  open(write("home/sensors.wrl", "#VRML V2.0 utf8\n"
                                 "Transform { translation 1 0 0 children [\n"
                                 "  ORTSensor { position 0 2 0 direction 0 1 0 }\n"
                                 "  ORTSensor { size 1 1 columns 2 }\n"
                                 "  ORTSensor { quantity \"LUMINANCE\" direction 0 0 -1 } ] }\n"));
  Probes probes;
  showSensors(*editor, probes);
  ASSERT_EQ(probes.all().size(), 3u);
  EXPECT_EQ(probes.all()[0].point, (std::array<double, 3>{1, 2, 0}));
  EXPECT_STREQ(unitOf(probes.all()[0]), "lx");
  EXPECT_EQ(probes.all()[1].point, (std::array<double, 3>{1, 0, 0})) << "the middle of two points";
  EXPECT_TRUE(probes.all()[1].isMean());
  EXPECT_FALSE(canBeKept(probes.all()[1]));
  EXPECT_THROW(keepInWorld(*editor, probes.all()[1], front()), EditError);
  EXPECT_EQ(probes.all()[2].point, (std::array<double, 3>{1, 0, 0}));
  EXPECT_STREQ(unitOf(probes.all()[2]), "cd/m2");
  EXPECT_THROW(showSensors(*editor, probes), EditError) << "all are shown";
  EXPECT_EQ(probes.all().size(), 3u);
  open(write("home/grid.wrl", "#VRML V2.0 utf8\nORTSensor { size 1 1 columns 100 rows 100 }\n"));
  EXPECT_THROW(showSensors(*editor, probes), EditError) << "it has too many points";
  open(write("home/bad.wrl", "#VRML V2.0 utf8\nORTSensor { direction 0 0 0 }\n"));
  EXPECT_THROW(showSensors(*editor, probes), picture::SensorError);
}

TEST_F(Library, AProbeOfLuminanceLooksAsTheViewerDoes) {
  Probes probes;
  probes.add({0, 0, 1});
  probes.add({0, 0, 20}); // behind the viewer at 0 0 10
  probes.add(Region{}, front());
  keepInWorld(*editor, probes.all()[0], front());
  const auto* const sensor = nodeCast<nodes::ORTSensor>(editor->selected());
  ASSERT_TRUE(sensor);
  EXPECT_EQ(sensor->quantity, "LUMINANCE");
  EXPECT_EQ(sensor->position, (Vec3f{0, 0, 10}));
  EXPECT_NEAR(sensor->direction.z, -1, 1e-6);
  EXPECT_THROW(keepInWorld(*editor, probes.all()[1], front()), EditError);
  EXPECT_THROW(keepInWorld(*editor, probes.all()[2], front()), EditError);
  EXPECT_FALSE(canBeKept(probes.all()[2]));
}

} // namespace
