// window_overlay.cpp: Tests the lines of the window's overlay. They say how the picture was made,
// and give an error only for a still picture.
#include <gtest/gtest.h>

#include <algorithm>

#include "session/input/editor_keys.h"
#include "session/overlay.h"

using namespace vv;
using Showing = SessionFacts::Showing;

namespace {

// A world that moves, whose last picture has figures that mean nothing.
SessionFacts facts(Showing showing, double frameRate) {
  SessionFacts f;
  f.showing = showing;
  f.frameRate = frameRate;
  f.width = 400;
  f.height = 300;
  f.samples = 12;
  f.stats.rays.camera = 1000;
  f.stats.time.render = 1;
  f.stats.error.pixels = 100;
  f.stats.error.halfWidth = 0.25;
  f.finished = true;
  return f;
}

std::string brief(const SessionFacts& f) {
  const std::vector<std::string> lines = overlayLines(f, false, OverlayLevel::brief);
  return lines.size() == 1 ? lines[0] : "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST(Overlay, aPreviewIsCalledOne) {
  EXPECT_TRUE(brief(facts(Showing::preview, 29)).starts_with("preview   29 fps"));
  EXPECT_TRUE(
      brief(facts(Showing::preview, 0)).starts_with("preview")); // the motion has just ended
  EXPECT_TRUE(brief(facts(Showing::samples, 29)).starts_with("raw samples   29 fps"));
  // "all" says what has filtered it.
  SessionFacts filtered = facts(Showing::preview, 29);
  const auto says = [&](const std::string& line) {
    const auto lines = overlayLines(filtered, false, OverlayLevel::all);
    return std::find(lines.begin(), lines.end(), line) != lines.end();
  };
  EXPECT_TRUE(says("\tfiltered by vv itself"));
  filtered.denoisedBy = "Open Image Denoise 2.5.1";
  EXPECT_TRUE(says("\tfiltered by Open Image Denoise 2.5.1"));
  filtered.showing = Showing::still;
  EXPECT_FALSE(says("\tfiltered by Open Image Denoise 2.5.1"));
  SessionFacts fading = facts(Showing::fading, 0);
  fading.wanted = 256;
  fading.finished = false;
  EXPECT_TRUE(brief(fading).starts_with("12 of 256 samples over a preview"));
  SessionFacts still = facts(Showing::still, 0);
  still.wanted = 256;
  still.finished = false;
  EXPECT_TRUE(brief(still).starts_with("12 of 256 samples"));
  EXPECT_FALSE(has(brief(still), "preview"));
}

TEST(Overlay, onlyAStillPictureHasAnError) {
  for (const Showing showing : {Showing::preview, Showing::samples, Showing::fading})
    for (const double rate : {0.0, 30.0})
      for (const OverlayLevel level : {OverlayLevel::brief, OverlayLevel::all})
        for (const std::string& line : overlayLines(facts(showing, rate), false, level))
          EXPECT_FALSE(has(line, "%")) << line;
  SessionFacts still = facts(Showing::still, 0);
  still.wanted = 12;
  EXPECT_TRUE(has(brief(still), "error 25 %"));
}

TEST(Overlay, nothingIsSaidBeforeThereIsAPicture) {
  EXPECT_EQ(brief(SessionFacts()), "first picture ...");
  EXPECT_TRUE(overlayLines(SessionFacts(), false, OverlayLevel::none).empty());
}

// In such a world previews are all that there is.
TEST(Overlay, aRestlessWorldIsSaidToHavePauses) {
  SessionFacts restless = facts(Showing::preview, 29);
  EXPECT_FALSE(has(brief(restless), "P pauses"));
  restless.isRestless = true;
  EXPECT_TRUE(has(brief(restless), "P pauses: full picture"));
  EXPECT_FALSE(has(overlayLines(restless, true, OverlayLevel::brief)[0], "P pauses"));
  InputEvent key;
  key.kind = InputEvent::Kind::down;
  key.text = "P";
  EXPECT_EQ(actionOf(key), Action::pause);
}

TEST(Overlay, theHelpListsAllKeys) {
  EXPECT_EQ(helpLines(false).size(), keyTable().size() + mouseTable().size());
  const std::vector<std::string> lines = helpLines(true);
  EXPECT_EQ(lines.size(), editorTable().size());
  for (const std::string& line : lines) EXPECT_LT(line.size(), 100u) << "a small window cuts it";
  InputEvent key;
  key.kind = InputEvent::Kind::down;
  key.text = "N";
  EXPECT_EQ(actionOf(key), Action::samples);
  key.shift = true;
  EXPECT_EQ(actionOf(key), Action::none);
}

// The keys of the editor are those of the table that the help shows.
TEST(Overlay, theEditorTakesTheKeysOfItsTable) {
  const auto action = [](const char* key, bool control = false, bool shift = false) {
    InputEvent event;
    event.kind = InputEvent::Kind::down;
    event.text = key;
    event.control = control;
    event.shift = shift;
    return editorActionOf(event);
  };
  EXPECT_EQ(action("S"), EditorAction::scale);
  EXPECT_EQ(action("S", true), EditorAction::save);
  EXPECT_EQ(action("V"), EditorAction::probe);
  EXPECT_EQ(action("V", false, true), EditorAction::rectangle);
  EXPECT_EQ(action("Z", true), EditorAction::undo);
  EXPECT_EQ(action("Y", true), EditorAction::redo);
  EXPECT_EQ(action("Z", true, true), EditorAction::redo);
  EXPECT_EQ(action("Delete"), EditorAction::remove);
  EXPECT_EQ(action("\\"), EditorAction::showA);
  EXPECT_EQ(action("D"), EditorAction::showDifference);
  EXPECT_EQ(action("D", false, true), EditorAction::duplicate);
  EXPECT_EQ(action("."), EditorAction::frame) << "not the minus of a number behind it";
  EXPECT_EQ(action("E"), EditorAction::none) << "a key of the window";
  EXPECT_EQ(action("click"), EditorAction::none);
  EXPECT_EQ(action(""), EditorAction::none);
}
