// editor_thumbnails.cpp: Tests the small pictures of the textures that a sheet shows: their pixels,
// files of all kinds, hostile ones included, and what is read again.
#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "edit/edit_model.h"
#include "libpicture/files/formats.h"
#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using xvrml::Image;

// A picture whose first row from the top is red, and whose others are blue.
Image redAbove(int width, int height) {
  Image image{width, height, 3, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int part : {y == height - 1 ? 255 : 0, 0, y == height - 1 ? 0 : 255})
        image.pixels.push_back(uint8_t(part));
  return image;
}

TEST(Thumbnail, HasThePixelsOfASmallPicture) {
  const Thumbnail small = thumbnailOf(redAbove(2, 2));
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 2);
  EXPECT_EQ(small.rgba, (std::vector<uint8_t>{255, 0, 0, 255, 255, 0, 0, 255, //
                                              0, 0, 255, 255, 0, 0, 255, 255}));
  EXPECT_EQ(small.magnification(), 32);
  const Thumbnail grey = thumbnailOf({1, 1, 2, {100, 50}});
  EXPECT_EQ(grey.rgba, (std::vector<uint8_t>{100, 100, 100, 50}));
}

TEST(Thumbnail, IsTheMeanOfPartsOfALargePicture) {
  const Thumbnail wide = thumbnailOf(redAbove(1000, 100));
  EXPECT_EQ(wide.width, 64);
  EXPECT_EQ(wide.height, 6);
  EXPECT_EQ(wide.magnification(), 1);
  // The first row is about a sixteenth of the part, of which every fourth row is taken.
  EXPECT_GT(wide.rgba[0], 30);
  EXPECT_LT(wide.rgba[0], 80);
  EXPECT_EQ(wide.rgba[0] + wide.rgba[2], 255);
  EXPECT_EQ(wide.rgba[size_t(64 * 4 * 3)], 0) << "below";
  EXPECT_EQ(thumbnailOf(redAbove(1, 5000)).width, 1);
}

TEST(Thumbnail, BrokenPicturesHaveNone) {
  for (const Image& broken : {Image{}, Image{-1, 5, 3, {}}, Image{5, 0, 3, {}},
                              Image{2, 2, 3, {1, 2, 3}}, Image{2, 2, 7, {}}})
    EXPECT_EQ(thumbnailOf(broken).width, 0);
}

struct Textures : testing::Test {
  const std::string folder = testing::TempDir();
  EditModel model;
  double seconds = 0;

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder + name, std::ios::binary) << bytes;
  }
  void writePng(const std::string& name, uint8_t grey, int side = 4) const {
    write(name,
          picture::pngOf(std::vector<uint8_t>(size_t(side) * size_t(side), grey), side, side, 1));
  }
  // Updates the model until the node has a thumbnail that differs from the last one.
  const Thumbnail* wait(EditedWorld& world, const char* name, uint64_t last = 0) {
    for (int i = 0; i < 2000; ++i) {
      model.update(world.editor, front(), true, seconds += 1);
      const Thumbnail* const found = model.thumbnails().of(*world.node(name));
      if (found && found->number != last) return found;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return nullptr;
  }
};

TEST_F(Textures, OfTheNodeAndOfItsFieldsAreShown) {
  writePng("thumbnail_grey.png", 90);
  EditedWorld world(
      "#VRML V2.0 utf8\nShape { appearance DEF A Appearance { material DEF M PhysicalMaterial {\n"
      "baseTexture DEF B ImageTexture { url [ \"thumbnail_none.png\" \"thumbnail_grey.png\" ] }\n"
      "normalTexture DEF N PixelTexture { image 1 1 3 0x8080ff } }\n"
      "texture DEF T ImageTexture { url \"thumbnail_none.png\" } } }\n");
  world.editor.select({world.node("M")});
  const Thumbnail* const base = wait(world, "B");
  ASSERT_TRUE(base);
  EXPECT_EQ(base->error, "");
  EXPECT_EQ(base->rgba, std::vector<uint8_t>([] {
              std::vector<uint8_t> all;
              for (int i = 0; i < 16; ++i) all.insert(all.end(), {90, 90, 90, 255});
              return all;
            }()));
  ASSERT_TRUE(wait(world, "N"));
  EXPECT_EQ(wait(world, "N")->rgba, (std::vector<uint8_t>{128, 128, 255, 255}));
  EXPECT_EQ(model.thumbnails().nodes().size(), 2u);
  world.editor.select({world.node("T")});
  const Thumbnail* const none = wait(world, "T");
  ASSERT_TRUE(none);
  EXPECT_EQ(none->width, 0);
  EXPECT_NE(none->error.find("thumbnail_none.png"), std::string::npos) << none->error;
  EXPECT_EQ(model.thumbnails().of(*world.node("N")), nullptr) << "it is not shown any more";
  std::filesystem::remove(folder + "thumbnail_grey.png");
}

TEST_F(Textures, TheNextUrlIsShownInPlaceOfADamagedFile) {
  writePng("thumbnail_good.png", 90);
  write("thumbnail_cut.png",
        std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\4\0\0\0\4\x08\0\0\0\0", 29));
  writePng("thumbnail_large.png", 1, 6000); // 36 million pixels, which renderers show
  const auto shown = [this](const char* urls) {
    EditedWorld world(fmt::format("#VRML V2.0 utf8\nShape {{ appearance Appearance {{ texture "
                                  "DEF T ImageTexture {{ url [ {} ] }} }} }}\n",
                                  urls));
    world.editor.select({world.node("T")});
    const Thumbnail* const found = wait(world, "T");
    return found ? *found : Thumbnail();
  };
  const Thumbnail second =
      shown("\"thumbnail_cut.png\" \"thumbnail_none.png\" \"thumbnail_good.png\"");
  EXPECT_EQ(second.error, "");
  ASSERT_EQ(second.width, 4);
  EXPECT_EQ(second.rgba[0], 90);
  const Thumbnail none = shown("\"thumbnail_cut.png\" \"thumbnail_none.png\"");
  EXPECT_EQ(none.width, 0);
  EXPECT_NE(none.error.find("PNG"), std::string::npos) << none.error;
  const Thumbnail large = shown("\"thumbnail_large.png\" \"thumbnail_good.png\"");
  EXPECT_EQ(large.width, 0) << "another picture than the renderer's";
  EXPECT_NE(large.error.find("6000 x 6000"), std::string::npos) << large.error;
  for (const char* file : {"thumbnail_good.png", "thumbnail_cut.png", "thumbnail_large.png"})
    std::filesystem::remove(folder + file);
}

TEST_F(Textures, AnEditShowsAnotherPicture) {
  writePng("thumbnail_1.png", 10);
  writePng("thumbnail_2.png", 20);
  EditedWorld world(
      "#VRML V2.0 utf8\nShape { appearance Appearance { texture DEF T ImageTexture {\n"
      "url \"thumbnail_1.png\" } } }\n");
  world.editor.select({world.node("T")});
  const Thumbnail* first = wait(world, "T");
  ASSERT_TRUE(first);
  EXPECT_EQ(first->rgba[0], 10);
  const uint64_t number = first->number;
  for (int i = 0; i < 5; ++i) model.update(world.editor, front(), true, seconds += 1);
  EXPECT_EQ(model.thumbnails().of(*world.node("T"))->number, number) << "nothing is read again";
  world.editor.editor().set(*world.node("T"), "url", xvrml::MFString{"thumbnail_2.png"});
  const Thumbnail* const second = wait(world, "T", number);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->rgba[0], 20);
  for (const char* name : {"thumbnail_1.png", "thumbnail_2.png"})
    std::filesystem::remove(folder + name);
}

TEST_F(Textures, HostileFilesAreNamedAndNotDecoded) {
  // The header of a PNG file of 60,000 x 60,000 pixels, without them.
  std::string huge("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xea\x60\0\0\xea\x60\x08\x02\0\0\0", 29);
  write("thumbnail_huge.png", huge + std::string(1000, '\0'));
  write("thumbnail_text.png", "no picture at all");
  writePng("thumbnail_large.png", 1, 6000); // 36 million pixels
  for (const char* file : {"thumbnail_huge.png", "thumbnail_text.png", "thumbnail_large.png",
                           "data:image/png;base64,AAAA", "http://localhost/x.png"}) {
    EditedWorld world(
        fmt::format("#VRML V2.0 utf8\nShape {{ appearance Appearance {{ texture DEF T "
                    "ImageTexture {{ url \"{}\" }} }} }}\n",
                    file));
    world.editor.select({world.node("T")});
    const Thumbnail* const shown = wait(world, "T");
    ASSERT_TRUE(shown) << file;
    EXPECT_EQ(shown->width, 0) << file;
    EXPECT_NE(shown->error, "") << file;
  }
  for (const char* file : {"thumbnail_huge.png", "thumbnail_text.png", "thumbnail_large.png"})
    std::filesystem::remove(folder + file);
}

TEST_F(Textures, FewOfManyAreShown) {
  std::string text =
      "#VRML V2.0 utf8\nShape { appearance Appearance { texture DEF M MultiTexture { "
      "texture [\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("PixelTexture {{ image 1 1 1 {} }}\n", i);
  EditedWorld world(text + "] } } }\n");
  world.editor.select({world.node("M")});
  for (int i = 0; i < 20; ++i) model.update(world.editor, front(), true, seconds += 1);
  EXPECT_EQ(model.thumbnails().nodes().size(), TextureThumbnails::mostShown);
}

} // namespace
