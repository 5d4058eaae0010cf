// tcl_chess.cpp: the chess set of examples/scenes, moved by its Tcl Script. The pieces on the board
// agree with the position that the Script sends.
#include <cmath>
#include <map>

#include "conformance/events/tcl_world.h"

namespace xvrml {
namespace {

class TclChess : public Tcl {
 protected:
  static std::unique_ptr<Browser> start(bool ownProcess = false) {
    BrowserOptions options;
    options.scriptPath = XVRML_SCRIPTS;
    options.scriptIsolation =
        ownProcess ? BrowserOptions::Isolation::automatic : BrowserOptions::Isolation::never;
    return std::make_unique<Browser>(loadWorld("examples/scenes/chess.wrl"), options);
  }
  static void run(Browser& browser, double until, double step) {
    for (int64_t i = int64_t(browser.now() / step) + 1; double(i) * step < until; ++i)
      browser.tick(double(i) * step);
    browser.tick(until);
  }
  static std::string text(Browser& browser, const char* out) {
    return textOf(browser.get(*browser.node("Chess"), out));
  }

  // Returns the kinds of pieces by the names of their nodes.
  static std::map<std::string, char> set() {
    std::map<std::string, char> nodes;
    for (int file = 0; file < 8; ++file) {
      const std::string name = std::string("Piece_") + char('a' + file);
      nodes[name + "1"] = "RNBQKBNR"[file];
      nodes[name + "2"] = 'P';
      nodes[name + "7"] = 'p';
      nodes[name + "8"] = "rnbqkbnr"[file];
    }
    for (const char kind : {'q', 'r', 'b', 'n'}) {
      nodes[std::string("Spare_w") + kind] = char(kind - 32);
      nodes[std::string("Spare_b") + kind] = kind;
    }
    return nodes;
  }
  static Vec3f place(Browser& browser, const std::string& name) {
    return std::get<Vec3f>(browser.get(*browser.node(name), "translation"));
  }
  // Returns the first field of the FEN, from the positions of the pieces.
  static std::string placement(Browser& browser) {
    std::string board(64, '.');
    for (const auto& [name, kind] : set()) {
      const Vec3f at = place(browser, name);
      const float file = at.x + 3.5f, row = at.z + 3.5f;
      if (file < -.5f || file > 7.5f || row < -.5f || row > 7.5f) continue;
      EXPECT_EQ(file, std::round(file)) << name;
      EXPECT_EQ(row, std::round(row)) << name;
      EXPECT_EQ(at.y, 0) << name;
      char& square = board[size_t(row) * 8 + size_t(file)];
      EXPECT_EQ(square, '.') << name << " stands on another piece";
      square = kind;
    }
    std::string fen;
    for (size_t row = 0; row < 8; ++row) {
      if (row) fen += '/';
      for (size_t file = 0, empty = 0; file < 8; ++file) {
        const char c = board[row * 8 + file];
        empty = c == '.' ? empty + 1 : empty;
        const bool last = file == 7 || board[row * 8 + file + 1] != '.';
        if (c == '.' && last) {
          fen += char('0' + empty);
          empty = 0;
        }
        if (c != '.') fen += c;
      }
    }
    return fen;
  }
  static std::string stated(Browser& browser) {
    const std::string fen = text(browser, "position");
    return fen.substr(0, fen.find(' '));
  }
  static void play(Browser& browser, const char* move) {
    browser.set(*browser.node("Chess"), "play", std::string(move));
  }
  // Plays moves and waits until they are complete.
  static void playAll(Browser& browser, std::initializer_list<const char*> moves) {
    for (const char* move : moves) {
      play(browser, move);
      run(browser, browser.now() + 1, 0.1);
      EXPECT_EQ(placement(browser), stated(browser)) << move;
    }
  }
};

TEST_F(TclChess, PlaysItsGameByTheClockOfTheWorld) {
  for (const bool ownProcess : {false, true}) {
    const auto browser = start(ownProcess);
    EXPECT_EQ(text(*browser, "position"),
              "rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR w KQkq - 0 1");
    EXPECT_EQ(placement(*browser), stated(*browser));
    run(*browser, 12, 1 / 30.);
    EXPECT_EQ(text(*browser, "position"),
              "rn1qkbnr/ppp2ppp/3p4/4P3/4P3/5Q2/PPP2PPP/RNB1KB1R b KQkq - 0 5")
        << ownProcess;
    run(*browser, 60, 0.5);
    EXPECT_EQ(text(*browser, "position"), "1n1Rkb1r/p4ppp/4q3/4p1B1/4P3/8/PPP2PPP/2K5 b k - 1 17");
    EXPECT_EQ(text(*browser, "status"), "Checkmate: White wins");
    EXPECT_EQ(placement(*browser), stated(*browser));
    for (const Diagnostic& d : browser->world().diagnostics.list()) ADD_FAILURE() << d.text();
  }
}

TEST_F(TclChess, APictureAtATimeIsTheSameHoweverTimeWentOn) {
  const auto fine = start(), coarse = start(), once = start();
  for (const double time : {1.3, 5.4, 20.1}) {
    run(*fine, time, 1 / 60.);
    run(*coarse, time, 0.7);
    once->tick(time);
    for (const auto& [name, kind] : set()) {
      EXPECT_EQ(place(*fine, name), place(*coarse, name)) << name << " at " << time;
      EXPECT_EQ(place(*fine, name), place(*once, name)) << name << " at " << time;
    }
  }
}

TEST_F(TclChess, PlaysMovesThatAreSentToIt) {
  const auto browser = start();
  playAll(*browser, {"e4", "e7e5", "Nf3", "Nc6", "Bc4", "Nf6", "O-O"});
  EXPECT_EQ(text(*browser, "position"),
            "r1bqkb1r/pppp1ppp/2n2n2/4p3/2B1P3/5N2/PPPP1PPP/RNBQ1RK1 b kq - 5 4");
  EXPECT_EQ(text(*browser, "status"), "Black to move");
  playAll(*browser, {"Qxd2"});
  EXPECT_EQ(text(*browser, "status"), "illegal move: Qxd2");
  playAll(*browser, {"hello"});
  EXPECT_EQ(text(*browser, "status"), "no move: hello");
  EXPECT_EQ(text(*browser, "position"),
            "r1bqkb1r/pppp1ppp/2n2n2/4p3/2B1P3/5N2/PPPP1PPP/RNBQ1RK1 b kq - 5 4");
}

TEST_F(TclChess, CapturesEnPassantAndPromotionsMoveTheRightPieces) {
  const auto browser = start();
  playAll(*browser, {"e4", "a6", "e5", "d5", "exd6", "a5", "dxc7", "a4", "cxb8=Q", "a3", "Qxa8",
                     "axb2", "Nf3", "bxc1=N", "Qxc1"});
  EXPECT_EQ(stated(*browser), "Q1bqkbnr/1p2pppp/8/8/8/5N2/P1PP1PPP/RNQ1KB1R");
  EXPECT_FALSE(place(*browser, "Spare_wq") == (Vec3f{-6.2f, 0, 3.5f}));
  EXPECT_EQ(place(*browser, "Piece_e2"), (Vec3f{-6.2f, 0, 3.5f})); // the pawn, in the queen's place
  EXPECT_GT(place(*browser, "Piece_d7").x, 4.8f);
}

TEST_F(TclChess, MovesThatComeAtOnceAreMadeOneAfterTheOther) {
  const auto browser = start();
  for (const char* move : {"e4", "e5", "Nf3", "Nc6"}) play(*browser, move);
  EXPECT_EQ(stated(*browser), "rnbqkbnr/pppppppp/8/8/4P3/8/PPPP1PPP/RNBQKBNR");
  run(*browser, 1.5, 0.1);
  EXPECT_EQ(stated(*browser), "rnbqkbnr/pppp1ppp/8/4p3/4P3/8/PPPP1PPP/RNBQKBNR");
  run(*browser, 5, 0.1);
  EXPECT_EQ(stated(*browser), "r1bqkbnr/pppp1ppp/2n5/4p3/4P3/5N2/PPPP1PPP/RNBQKB1R");
  EXPECT_EQ(placement(*browser), stated(*browser));
}

} // namespace
} // namespace xvrml
