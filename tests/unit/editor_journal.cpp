// editor_journal.cpp: Tests that edits that are not saved are kept beside the file, and are taken
// over by the next program.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;
namespace fs = std::filesystem;

constexpr const char* hall = "#VRML V2.0 utf8\n"
                             "# The hall\n"
                             "DEF LAMP PointLight { intensity 0.80 # by day\n"
                             "}\n";
constexpr const char* dim = "#VRML V2.0 utf8\n"
                            "# The hall\n"
                            "DEF LAMP PointLight { intensity 0.5 # by day\n"
                            "}\n";

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void putContent(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

// A program that edits a file, until it is destroyed as if it had been killed.
struct Program {
  explicit Program(const std::string& path) : browser(loadWorld(path)), editor(browser) {
    journal().look();
  }
  Program(const std::string& path, LeftEdits& left)
      : browser(loadWorldFromMemory(left.content.text, path)), editor(browser) {
    journal().adopt(left);
  }
  Journal& journal() { return editor.journal(); }
  void dimTo(float intensity) {
    editor.editor().set(*browser.node("LAMP"), "intensity", intensity);
  }

  Browser browser;
  WorldEditor editor;
};

struct EditorJournal : testing::Test {
  void SetUp() override {
    folder = testing::TempDir() + "journal_" +
             testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder);
    fs::create_directory(folder);
    world = folder + "/hall.wrl";
    journal = folder + "/.hall.wrl.vv-edits";
    putContent(world, hall);
  }
  void TearDown() override { fs::remove_all(folder); }

  // Leaves edits as a program does that is killed.
  void leave(float intensity = 0.5f) {
    Program program(world);
    program.dimTo(intensity);
    ASSERT_EQ(program.journal().keep(), journal);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder))
      all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }

  std::string folder, world, journal;
};

using Names = std::vector<std::string>;

TEST_F(EditorJournal, EditsAreKeptWithTheTextAndRemovedWhenSaved) {
  Program program(world);
  program.journal().advance(0);
  EXPECT_EQ(names(), Names{"hall.wrl"}) << "nothing has been edited";
  program.dimTo(0.5f);
  EXPECT_EQ(program.journal().keep(), journal);
  const std::string kept = contentOf(journal);
  EXPECT_TRUE(kept.ends_with(std::string("\n\n") + dim)) << kept;
  EXPECT_EQ(std::count(kept.begin(), kept.end(), '\n') - 4, 4) << "the text begins in line 5";
  EXPECT_EQ(contentOf(world), hall);
  EXPECT_EQ(names(), (Names{".hall.wrl.vv-edits", "hall.wrl"}));
  program.editor.save();
  EXPECT_EQ(names(), Names{"hall.wrl"});
  EXPECT_EQ(contentOf(world), dim);
  EXPECT_EQ(program.journal().takeMessage(), "");
}

TEST_F(EditorJournal, WritesFollowEachOtherInTheirTime) {
  {
    Program program(world);
    program.dimTo(0.5f);
    program.journal().advance(100); // at once
    program.dimTo(0.25f);
    program.journal().advance(100.1); // too early
  }
  EXPECT_NE(contentOf(journal).find("intensity 0.5 "), std::string::npos);
  fs::remove(journal);
  {
    Program program(world);
    program.dimTo(0.5f);
    program.journal().advance(100);
    program.dimTo(0.25f);
    EXPECT_EQ(program.journal().keep(), journal) << "the end does not wait";
  }
  EXPECT_NE(contentOf(journal).find("intensity 0.25 "), std::string::npos);
}

TEST_F(EditorJournal, NothingStaysOfEditsThatAreUndoneOrThrownAway) {
  Program program(world);
  program.dimTo(0.5f);
  program.journal().keep();
  program.editor.undo();
  program.journal().advance(100);
  EXPECT_EQ(names(), Names{"hall.wrl"});
  program.editor.redo();
  EXPECT_EQ(program.journal().keep(), journal);
  program.journal().throwAway();
  program.journal().advance(200);
  EXPECT_EQ(program.journal().keep(), "");
  EXPECT_EQ(program.journal().failure(), "");
  EXPECT_EQ(names(), Names{"hall.wrl"});
  program.dimTo(0.25f); // the user has stayed after all
  EXPECT_EQ(program.journal().keep(), journal);
}

TEST_F(EditorJournal, TheNextProgramFindsAndTakesThem) {
  leave();
  Program before(world);
  ASSERT_TRUE(before.journal().left());
  EXPECT_EQ(before.journal().left()->path, journal);
  EXPECT_NE(before.journal().takeMessage().find("unsaved edits"), std::string::npos);
  const std::shared_ptr<LeftEdits> left = before.journal().take();
  Program program(world, *left);
  EXPECT_TRUE(program.editor.isChanged());
  EXPECT_EQ(program.editor.editor().text(), dim);
  EXPECT_EQ(program.editor.undo(), "") << "what was taken over is no step";
  const NodeRef lamp = program.browser.node("LAMP");
  EXPECT_FLOAT_EQ(std::get<float>(lamp->get(*lamp->type().find("intensity"))), 0.5f);
  program.dimTo(0.25f); // other edits follow
  EXPECT_EQ(program.journal().keep(), journal);
  EXPECT_NE(contentOf(journal).find("intensity 0.25 "), std::string::npos);
  EXPECT_EQ(program.editor.undo(), "Set PointLight.intensity");
  EXPECT_EQ(program.editor.editor().text(), dim);
  EXPECT_TRUE(program.editor.isChanged());
  program.editor.save();
  EXPECT_EQ(contentOf(world), dim);
  EXPECT_EQ(names(), Names{"hall.wrl"});
  EXPECT_FALSE(program.editor.isChanged());
}

TEST_F(EditorJournal, LeftEditsCanBeThrownAway) {
  leave();
  Program program(world);
  program.journal().throwLeftAway();
  EXPECT_FALSE(program.journal().left());
  EXPECT_EQ(names(), Names{"hall.wrl"});
  EXPECT_THROW(program.journal().throwLeftAway(), EditError);
  EXPECT_THROW(program.journal().take(), EditError);
}

TEST_F(EditorJournal, AWorldWithEditsTakesNoOthers) {
  leave();
  Program program(world);
  program.dimTo(0.25f);
  EXPECT_THROW(program.journal().take(), EditError);
  EXPECT_EQ(program.journal().keep(), journal + "-2") << "what is left stays";
  program.editor.undo();
  EXPECT_NE(program.journal().take(), nullptr);
}

TEST_F(EditorJournal, TwoProgramsHaveTwoFiles) {
  Program first(world), second(world);
  first.dimTo(0.5f);
  second.dimTo(0.25f);
  EXPECT_EQ(first.journal().keep(), journal);
  EXPECT_EQ(second.journal().keep(), journal + "-2");
  Program third(world);
  EXPECT_FALSE(third.journal().left()) << "those that run are left alone";
  EXPECT_EQ(third.journal().takeMessage(), "");
  first.dimTo(0.75f);
  EXPECT_EQ(first.journal().keep(), journal);
  EXPECT_NE(contentOf(journal).find("intensity 0.75 "), std::string::npos);
  EXPECT_NE(contentOf(journal + "-2").find("intensity 0.25 "), std::string::npos);
  fs::remove(journal); // somebody tidies up
  first.dimTo(0.5f);
  EXPECT_EQ(first.journal().keep(), journal);
}

TEST_F(EditorJournal, EditsOfAnotherTextAreNotUsed) {
  leave();
  putContent(world, "#VRML V2.0 utf8\nDEF LAMP PointLight { }\n");
  Program program(world);
  EXPECT_FALSE(program.journal().left());
  const std::string message = program.journal().takeMessage();
  EXPECT_NE(message.find("has changed since"), std::string::npos) << message;
  EXPECT_TRUE(fs::exists(journal)) << "its owner may read it";
}

TEST_F(EditorJournal, EditsAreNotAdoptedForAnotherText) {
  leave();
  Program before(world);
  const std::shared_ptr<LeftEdits> left = before.journal().take();
  putContent(world, "#VRML V2.0 utf8\nDEF LAMP PointLight { }\n");
  EXPECT_THROW(Program(world, *left), EditError);
}

TEST_F(EditorJournal, AFileThatSaysTheSameIsNotOffered) {
  leave();
  putContent(world, dim); // it was saved, and the program killed before the journal was removed
  Program program(world);
  EXPECT_FALSE(program.journal().left());
  EXPECT_EQ(program.journal().takeMessage(), "");
  EXPECT_EQ(names(), Names{"hall.wrl"});
}

TEST_F(EditorJournal, ItIsForItsUserAlone) {
  leave();
  struct stat info;
  ASSERT_EQ(::stat(journal.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777u, 0600u);
}

TEST_F(EditorJournal, LinksAreNotFollowed) {
  const std::string victim = folder + "/victim";
  putContent(victim, "precious");
  fs::create_symlink(victim, journal);
  fs::create_symlink(victim, journal + "-2.new");
  Program program(world);
  EXPECT_NE(program.journal().takeMessage().find("symbolic link"), std::string::npos);
  program.dimTo(0.5f);
  EXPECT_EQ(program.journal().keep(), journal + "-2");
  EXPECT_EQ(contentOf(victim), "precious");
  EXPECT_TRUE(fs::is_symlink(journal));
}

TEST_F(EditorJournal, AFileBehindALinkHasItsJournalBesideItself) {
  fs::create_directory(folder + "/links");
  fs::create_symlink(world, folder + "/links/other.wrl");
  Program program(folder + "/links/other.wrl");
  program.dimTo(0.5f);
  const std::string kept = program.journal().keep();
  EXPECT_EQ(fs::canonical(kept), fs::canonical(journal));
}

// It is read as a whole: a file with holes may have any size.
TEST_F(EditorJournal, AnEndlessJournalIsRefused) {
  leave();
  constexpr uint64_t bytes = uint64_t(5) << 30;
  const std::string head = "vv edits 1\nbase 1 0\ntext " + std::to_string(bytes) + " 0\n\n";
  putContent(journal, head);
  fs::resize_file(journal, head.size() + bytes);
  Program program(world);
  EXPECT_FALSE(program.journal().left());
  EXPECT_NE(program.journal().takeMessage().find("larger than the file"), std::string::npos);
}

TEST_F(EditorJournal, OfSeveralTheNewestIsReadAsAWhole) {
  leave();
  std::string flipped = contentOf(journal);
  flipped[flipped.size() - 3] ^= 1;
  for (const char* suffix : {"-2", "-3"}) {
    putContent(journal + suffix, flipped);
    fs::last_write_time(journal + suffix,
                        fs::last_write_time(journal) - std::chrono::hours(suffix[1] - '0'));
  }
  Program program(world);
  ASSERT_TRUE(program.journal().left());
  EXPECT_EQ(program.journal().left()->path, journal);
  EXPECT_EQ(program.journal().takeMessage().find("damaged"), std::string::npos);
  // The next one is found where the newest cannot be used.
  putContent(journal + "-2", contentOf(journal));
  fs::last_write_time(journal + "-2", fs::last_write_time(journal) - std::chrono::hours(1));
  putContent(journal, flipped);
  Program second(world);
  ASSERT_TRUE(second.journal().left());
  EXPECT_EQ(second.journal().left()->path, journal + "-2");
  EXPECT_NE(second.journal().takeMessage().find("damaged"), std::string::npos);
}

TEST_F(EditorJournal, WhatIsNoJournalIsRefusedWithOneMessage) {
  leave();
  const std::string good = contentOf(journal);
  std::string flipped = good;
  flipped[good.size() - 3] ^= 1;
  const std::pair<const char*, std::string> bad[] = {
      {"not complete", good.substr(0, good.size() - 5)},
      {"not complete", good + "more"},
      {"damaged", good.substr(0, 20)},
      {"damaged", std::string(1000, '\0')},
      {"damaged", "vv edits 1\nbase 99999999999999999999999 0\n"},
      {"not complete", "vv edits 1\nbase 1 0\ntext 18446744073709551615 0\n\n"},
      {"damaged", flipped},
      {"damaged", "#VRML V2.0 utf8\n"},
  };
  for (const auto& [why, bytes] : bad) {
    putContent(journal, bytes);
    Program program(world);
    EXPECT_FALSE(program.journal().left());
    const std::string message = program.journal().takeMessage();
    EXPECT_NE(message.find(why), std::string::npos) << message;
    EXPECT_NE(message.find(journal), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    program.dimTo(0.25f);
    EXPECT_EQ(program.journal().keep(), journal + "-2") << "it is not overwritten";
    program.journal().throwAway();
    EXPECT_EQ(contentOf(journal), bytes);
  }
  fs::remove(journal);
  fs::create_directory(journal);
  EXPECT_NE(Program(world).journal().takeMessage(), "");
  fs::remove(journal);
  ASSERT_EQ(::mkfifo(journal.c_str(), 0600), 0);
  EXPECT_NE(Program(world).journal().takeMessage().find("no regular file"), std::string::npos);
}

TEST_F(EditorJournal, WhereNothingCanBeWrittenItSaysSoOnce) {
  for (const char* suffix : {"", "-2", "-3", "-4", "-5", "-6", "-7", "-8", "-9"})
    fs::create_directory(journal + suffix);
  Program program(world);
  program.journal().takeMessage();
  program.dimTo(0.5f);
  program.journal().advance(0);
  EXPECT_NE(program.journal().takeMessage().find("kept nowhere"), std::string::npos);
  program.dimTo(0.25f);
  program.journal().advance(100);
  EXPECT_EQ(program.journal().keep(), "");
  EXPECT_EQ(program.journal().takeMessage(), "");
  EXPECT_NE(program.journal().failure(), "");
  fs::remove(journal + "-3");
  program.journal().advance(200); // tries again
  EXPECT_EQ(program.journal().keep(), journal + "-3");
}

TEST_F(EditorJournal, WorldsOfOthersHaveNoneUntilTheyAreSaved) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a file away";
  ASSERT_EQ(::chown(world.c_str(), 12345, gid_t(-1)), 0);
  Program program(world);
  program.dimTo(0.5f);
  EXPECT_EQ(program.journal().keep(), "");
  EXPECT_NE(program.journal().takeMessage().find("belongs to another user"), std::string::npos);
  program.dimTo(0.6f);
  EXPECT_EQ(program.journal().keep(), "");
  EXPECT_EQ(program.journal().takeMessage(), "") << "it is said once";
  EXPECT_EQ(names(), std::vector<std::string>{"hall.wrl"});
  program.editor.save();
  program.dimTo(0.7f);
  EXPECT_EQ(program.journal().keep(), journal);
}

TEST_F(EditorJournal, AStepThatIsOpenIsKept) {
  Program program(world);
  program.editor.editor().begin("Drag");
  program.dimTo(0.5f);
  EXPECT_EQ(program.journal().keep(), journal);
  EXPECT_TRUE(contentOf(journal).ends_with(dim));
  program.editor.editor().cancel();
  program.journal().advance(100);
  EXPECT_EQ(names(), Names{"hall.wrl"});
}

TEST_F(EditorJournal, EditsOutliveAWorldThatIsReplaced) {
  Program program(world);
  program.dimTo(0.5f);
  program.browser.replaceWorld({});
  program.journal().advance(0);
  EXPECT_NE(program.journal().takeMessage().find(journal), std::string::npos);
  EXPECT_TRUE(contentOf(journal).ends_with(dim));
  EXPECT_EQ(program.journal().keep(), journal);
}

TEST_F(EditorJournal, AnotherProgramsTextIsNoBase) {
  Program program(world);
  program.dimTo(0.5f);
  putContent(world, std::string(hall) + "# by another program\n");
  EXPECT_EQ(program.journal().keep(), journal);
  Program next(world);
  EXPECT_FALSE(next.journal().left());
}

TEST_F(EditorJournal, MarksOfTheFileStay) {
  putContent(world, std::string("\xef\xbb\xbf") + hall);
  leave();
  EXPECT_TRUE(contentOf(journal).ends_with(dim));
  Program before(world);
  ASSERT_TRUE(before.journal().left());
  Program program(world, *before.journal().take());
  program.editor.save();
  EXPECT_EQ(contentOf(world), std::string("\xef\xbb\xbf") + dim);
}

TEST_F(EditorJournal, AnEmptyOneIsSpokenOfAndRemoved) {
  putContent(journal, "");
  Program program(world);
  EXPECT_EQ(program.journal().takeMessage(),
            journal + " was empty, and has been removed: the vv that made it had ended before it "
                      "kept any edits");
  EXPECT_EQ(names(), Names{"hall.wrl"});
  program.dimTo(0.5f);
  EXPECT_EQ(program.journal().keep(), journal);
}

TEST_F(EditorJournal, AnEmptyOneOfAProgramThatRunsStays) {
  const JournalFile other = JournalFile::make(world);
  Program program(world);
  EXPECT_EQ(program.journal().takeMessage(), "");
  EXPECT_TRUE(fs::exists(journal));
}

TEST_F(EditorJournal, ItsNamesAreKnown) {
  EXPECT_TRUE(isJournalOf(world, journal));
  EXPECT_TRUE(isJournalOf(world, folder + "/./.hall.wrl.vv-edits-2"));
  EXPECT_TRUE(isJournalOf(world, journal + ".new"));
  EXPECT_FALSE(isJournalOf(world, world));
  EXPECT_FALSE(isJournalOf(world, folder + "/.other.wrl.vv-edits"));
  fs::create_symlink(journal, folder + "/link.wrl");
  EXPECT_TRUE(isJournalOf(world, folder + "/link.wrl"));
}

} // namespace
