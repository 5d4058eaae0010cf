// picture_notes.cpp: Tests that files say what a picture's note says, and nothing without one.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "libpicture/files/film.h"
#include "libpicture/files/formats.h"
#include "libpicture/files/read_note.h"
#include "libpicture/renderer.h"
#include "openrt/openrt.h"
#include "xvrml/browser.h"

using namespace picture;

namespace {

const std::string note = "preview: rebuilt from 3 samples per pixel, biased";

Picture pictureWith(const std::string& text) {
  Picture picture;
  picture.width = picture.height = 8;
  picture.note = text;
  picture.planes[RT_RGBA].assign(8 * 8 * 4, 0.5f);
  return picture;
}

std::string filmWith(FilmKind kind, const std::string& text) {
  Film film(kind, 16, 16, 10, text);
  const std::vector<uint8_t> grey(16 * 16 * 3, 128);
  film.add(grey);
  film.add(grey);
  return film.finish();
}

std::unique_ptr<xvrml::World> boxWorld() {
  return xvrml::loadWorldFromMemory(
      "#VRML V2.0 utf8\nViewpoint { position 0 0 5 } Shape { geometry Box { } }", "box.wrl");
}

size_t timesIn(const std::string& bytes, const std::string& text) {
  size_t times = 0;
  for (size_t at = bytes.find(text); at != bytes.npos; at = bytes.find(text, at + 1)) ++times;
  return times;
}

} // namespace

TEST(Notes, areInTheFilesOfTheFormatsThatKeepThem) {
  for (const Format& format : formatTable()) {
    SCOPED_TRACE(format.name);
    EXPECT_EQ(timesIn(format.encode(pictureWith(note)), note), format.keepsNote ? 1u : 0u);
    EXPECT_EQ(format.encode(pictureWith(note)) == format.encode(pictureWith("")),
              !format.keepsNote);
    EXPECT_EQ(timesIn(format.encode(pictureWith("")), "preview"), 0u);
  }
  EXPECT_EQ(formatsWith(&Format::keepsNote), "EXR, PNG, JPEG, PPM and HDR");
}

TEST(Notes, areReadFromFiles) {
  const std::string file = testing::TempDir() + "picture_note";
  const auto readBack = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return readNote(file);
  };
  for (const Format& format : formatTable()) {
    SCOPED_TRACE(format.name);
    const std::string bytes = format.encode(pictureWith(note));
    EXPECT_EQ(readBack(bytes), format.keepsNote ? note : "");
    EXPECT_EQ(readBack(format.encode(pictureWith(""))), "");
    for (size_t length = 0; length < bytes.size(); ++length) {
      const std::string read = readBack(bytes.substr(0, length));
      EXPECT_TRUE(read.empty() || read == note) << length;
    }
  }
  std::remove(file.c_str());
  EXPECT_EQ(readNote(file), "");
}

TEST(Notes, areInFilms) {
  for (const FilmKind kind : {FilmKind::gif, FilmKind::mp4, FilmKind::webm}) {
    if (!whyNoFilm(kind).empty()) continue;
    SCOPED_TRACE(int(kind));
    EXPECT_EQ(timesIn(filmWith(kind, note), note), 1u);
    EXPECT_EQ(timesIn(filmWith(kind, ""), "preview"), 0u);
    EXPECT_EQ(filmWith(kind, note), filmWith(kind, note));
  }
}

TEST(Notes, aRendererSaysWhichPicturesArePreviews) {
  xvrml::Browser browser(boxWorld());
  RenderSettings settings;
  settings.width = 16;
  settings.height = 12;
  settings.samples = 3;
  settings.preview = true;
  Renderer previews(browser, settings);
  for (int frame = 0; frame < 2; ++frame) {
    const Picture made = previews.render({}).picture;
    EXPECT_EQ(made.note, note);
    ASSERT_EQ(made.planes.size(), 1u);
    EXPECT_EQ(made.planes.begin()->first, uint32_t(RT_RGBA));
  }
  previews.change([](RenderSettings& s) { s.preview = false; });
  const Picture still = previews.render({}).picture;
  EXPECT_EQ(still.note, "");
  settings.preview = false;
  xvrml::Browser other(boxWorld());
  EXPECT_EQ(Renderer(other, settings).render({}).picture.planes, still.planes)
      << "nothing of a preview enters a picture after it";
}
