// editor_upload.cpp: Tests that a file which a page sends becomes a new file beside the world's and
// an Inline, and that nothing else is written.
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>

#include "base64.h"
#include "editor_support.h"
#include "server/limits.h"
#include "server/upload.h"

namespace {

using namespace editor_test;
using namespace vv::server;
namespace fs = std::filesystem;

constexpr const char* box = "#VRML V2.0 utf8\nShape { geometry Box { } }\n";

TEST(EditorUpload, NamesOfFilesArePlain) {
  EXPECT_EQ(plainFileName("leg.stl"), "leg.stl");
  EXPECT_EQ(plainFileName("Lamp 2 (b\xc3\xa4r).WRL.gz"), "Lamp_2__b__r_.WRL.gz");
  EXPECT_EQ(plainFileName("../../etc/x.wrl"), "x.wrl");
  EXPECT_EQ(plainFileName("C:\\models\\x.glb"), "x.glb");
  EXPECT_EQ(plainFileName(".hidden.x3d"), "_.hidden.x3d");
  EXPECT_EQ(plainFileName("-o.obj"), "_-o.obj");
  EXPECT_EQ(plainFileName(std::string(300, 'n') + ".ply"), std::string(64, 'n') + ".ply");
  for (const char* name : {"", "wrl", ".", "notes.txt", "run.sh", "world.wrl.vv-edits", "x.gz",
                           "stl.", "leg.stl/", "leg.stl\n"})
    EXPECT_THROW(plainFileName(name), xvrml::EditError) << name;
}

struct Edited {
  explicit Edited(const fs::path& path)
      : browser(xvrml::loadWorld(path.string())), editor(browser) {}
  xvrml::Browser browser;
  vv::WorldEditor editor;
};

class EditorUploadFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = testing::TempDir() + "upload_" +
             testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder);
    fs::create_directory(folder);
    put("world.wrl", "#VRML V2.0 utf8\nDEF G Group { }\n");
    world = std::make_unique<Edited>(folder / "world.wrl");
  }
  void TearDown() override {
    world.reset();
    fs::remove_all(folder);
  }

  void put(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  std::string contentOf(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder / name, std::ios::binary).rdbuf();
    return text.str();
  }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder))
      all.insert(entry.path().filename().string());
    return all;
  }
  // Sends a file in two parts, and puts it into the world. Returns why it is refused.
  std::string send(const std::string& name, const std::string& content) {
    Upload upload;
    try {
      upload.take(edit::Import{name, content.size()}, world->editor);
      const size_t half = content.size() / 2;
      upload.take(edit::ImportPart{base64Of(content.substr(0, half))}, world->editor);
      EXPECT_FALSE(upload.isComplete());
      upload.take(edit::ImportPart{base64Of(content.substr(half))}, world->editor);
      EXPECT_TRUE(upload.isComplete());
      upload.finish(world->editor);
      EXPECT_EQ(upload.size(), 0u);
      return "";
    } catch (const std::runtime_error& error) { return error.what(); }
  }

  fs::path folder;
  std::unique_ptr<Edited> world;
};

TEST_F(EditorUploadFiles, AFileIsWrittenBesideTheWorldAndNeverOverAnother) {
  put("box.wrl", "precious");
  EXPECT_EQ(send("box.wrl", box), "");
  EXPECT_EQ(contentOf("box.wrl"), "precious");
  EXPECT_EQ(contentOf("box-2.wrl"), box);
  EXPECT_NE(world->editor.editor().text().find("url [ \"box-2.wrl\" ]"), std::string::npos);
  world->editor.undo();
  EXPECT_FALSE(world->editor.isChanged());
  EXPECT_EQ(names(), (std::set<std::string>{"box-2.wrl", "box.wrl", "world.wrl"}));
}

TEST_F(EditorUploadFiles, WhatIsRefusedLeavesNothing) {
  EXPECT_NE(send("notes.txt", box).find("only worlds and meshes"), std::string::npos);
  EXPECT_NE(send("box.wrl", "").find("is empty"), std::string::npos);
  EXPECT_NE(send("box.wrl", "no world at all"), "");
  Upload upload;
  EXPECT_THROW(upload.take(edit::Import{"box.wrl", size_t(maxImportBytes) + 1}, world->editor),
               xvrml::EditError);
  upload.take(edit::ImportPart{base64Of(box)}, world->editor); // it has been refused
  EXPECT_EQ(upload.received(), 0u);
  for (const char* part : {"###=", "QUJD===", "QUJDRA=="}) { // the last one is too long
    upload.take(edit::Import{"box.wrl", 3}, world->editor);
    EXPECT_THROW(upload.take(edit::ImportPart{part}, world->editor), xvrml::EditError) << part;
    EXPECT_EQ(upload.size(), 0u);
  }
  EXPECT_EQ(names(), std::set<std::string>{"world.wrl"});
  EXPECT_FALSE(world->editor.isChanged());
}

} // namespace
