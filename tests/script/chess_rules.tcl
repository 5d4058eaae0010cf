# chess_rules.tcl: tests the rules, moves and games of examples/scenes/chess.tcl without a world:
# tclsh chess_rules.tcl CHESS.TCL. The expected numbers of positions (perft) are those that chess programs agree on.
source [lindex $argv 0]
set failures 0
proc expect {what got wanted} {
  if {$got eq $wanted} return
  puts "$what: $got, not $wanted"
  incr ::failures
}
proc at fen {rules::read $fen}
proc errorOf script {catch {uplevel 1 $script} why; return $why}

foreach {fen depth count} {
  {rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR w KQkq - 0 1} 3 8902
  {r3k2r/p1ppqpb1/bn2pnp1/3PN3/1p2P3/2N2Q1p/PPPBBPPP/R3K2R w KQkq - 0 1} 2 2039
  {8/2p5/3p4/KP5r/1R3p1k/8/4P1P1/8 w - - 0 1} 3 2812
  {r3k2r/Pppp1ppp/1b3nbN/nP6/BBP1P3/q4N2/Pp1P2PP/R2Q1RK1 w kq - 0 1} 2 264
  {rnbq1k1r/pp1Pbppp/2p5/8/2B5/8/PPP1NnPP/RNBQK2R w KQ - 1 8} 2 1486
} {
  expect "perft $depth of $fen" [rules::perft [at $fen] $depth] $count
  expect "FEN there and back" [rules::write [at $fen]] $fen
}

# Moves as text.
proc after {fen args} {
  set position [at $fen]
  foreach text $args {set position [rules::make $position [rules::find $position $text]]}
  rules::write $position
}
set start $rules::start
expect "e4" [after $start e4] {rnbqkbnr/pppppppp/8/8/4P3/8/PPPP1PPP/RNBQKBNR b KQkq e3 0 1}
expect "squares" [after $start e2e4 g8-f6 b1c3] {rnbqkb1r/pppppppp/5n2/8/4P3/2N5/PPPP1PPP/R1BQKBNR b KQkq - 2 2}
expect "castling" [after {r3k2r/8/8/8/8/8/8/R3K2R w KQkq - 0 1} O-O 0-0-0] {2kr3r/8/8/8/8/8/8/R4RK1 w - - 2 2}
expect "a rook that is taken" [after {r3k2r/8/8/8/8/8/8/R3K2R w KQkq - 0 1} Rxa8+ Kd7] {R6r/3k4/8/8/8/8/8/4K2R w K - 1 2}
expect "en passant" [after {4k3/3p4/8/4P3/8/8/8/4K3 b - - 0 1} d5 exd6] {4k3/8/3P4/8/8/8/8/4K3 b - - 0 2}
expect "promotion" [after {4k3/P7/8/8/8/8/8/4K3 w - - 0 1} a8=N] {N3k3/8/8/8/8/8/8/4K3 b - - 0 1}
expect "promotion by squares" [after {4k3/P7/8/8/8/8/8/4K3 w - - 0 1} a7a8q] {Q3k3/8/8/8/8/8/8/4K3 b - - 0 1}
expect "no such move" [errorOf {rules::find [at $start] Nf4}] {illegal move: Nf4}
expect "through check" [errorOf {rules::find [at {4kr2/8/8/8/8/8/8/4K2R w K - 0 1}] O-O}] {illegal move: O-O}
expect "pinned" [errorOf {rules::find [at {4k3/4r3/8/8/8/8/4N3/4K3 w - - 0 1}] Nc3}] {illegal move: Nc3}
expect "no move" [errorOf {rules::find [at $start] castle}] {no move: castle}
set rooks {4k3/8/8/8/R6R/8/8/4K3 w - - 0 1}
expect "two can" [errorOf {rules::find [at $rooks] Rd4}] {ambiguous move: Rd4}
proc san {fen text} {set p [at $fen]; rules::san $p [rules::find $p $text]}
expect "by file" [san $rooks a4d4] Rad4
expect "by rank" [san {4k3/8/R7/8/8/8/R7/K7 w - - 0 1} a6a4] R6a4
expect "by both" [san {4k3/8/8/1Q1Q4/8/8/8/KQ6 w - - 0 1} b5d3] Qb5d3
expect "takes with check" [san {4k3/8/8/8/8/8/3p4/4K2R w K - 0 1} Kxd2] Kxd2
expect "mate" [san {6k1/5ppp/8/8/8/8/8/4K2R w K - 0 1} h1h7] Rxh7
expect "back rank" [san {6k1/5ppp/8/8/8/8/8/R3K3 w - - 0 1} a1a8] Ra8#
expect "promotes" [san {3r2k1/4P3/8/8/8/8/8/4K3 w - - 0 1} e7d8q] exd8=Q+

# The state of the game.
proc state {fen {keys {}}} {lindex [rules::status [at $fen] $keys] 1}
expect "first" [state $start] {White to move}
expect "check" [state {4k3/8/8/8/8/8/4r3/4K3 w - - 0 1}] {White to move, in check}
expect "mated" [state {R5k1/5ppp/8/8/8/8/8/4K3 b - - 0 1}] {Checkmate: White wins}
expect "stalemate" [state {7k/5Q2/6K1/8/8/8/8/8 b - - 0 1}] {Stalemate: a draw}
expect "dead" [state {7k/8/6K1/8/8/8/8/6N1 b - - 0 1}] {A draw: neither side can win}
expect "fifty" [state {4k2r/8/8/8/8/8/8/4K2R w - - 100 80}] {White to move; a draw can be claimed: fifty moves}
set key [rules::key [at $start]]
expect "threefold" [state $start [list $key $key $key]] {White to move; a draw can be claimed: threefold repetition}
expect "an en passant that cannot be played" [lindex [rules::key [at [after $start e4]]] 3] 0
expect "one that can" [lindex [rules::key [at [after {4k3/8/8/8/3p4/8/4P3/4K3 w - - 0 1} e4]]] 3] [rules::square e3]

# Games.
set games [pgn::read {[Event "A \"test\""]
[Site "x"]
; to the end of the line: (
% escaped ) line
1. e4 {best (by test) } e5 $1 2.Nf3 (2. f4 exf4 (2... d5 {counter}) 3. Nf3) 2... Nc6!? 3 Bb5 a6?? 1/2-1/2

[Event "second"]
1. d4 *}]
expect "games" [llength $games] 2
expect "tag" [dict get [lindex $games 0 0] Event] {A "test"}
expect "moves" [lindex $games 0 1] {e4 e5 Nf3 Nc6!? Bb5 a6??}
expect "result" [lindex $games 0 2] 1/2-1/2
expect "second" [lindex $games 1 1] d4
expect "unreadable" [errorOf {pgn::read "1. e4 &"}] {PGN: cannot read "&"}
expect "unbalanced" [errorOf {pgn::read "1. e4 ) e5"}] {PGN: ")" without "("}
set position [at $start]
foreach text [lindex [pgn::read $game::opera] 0 1] {
  set move [rules::find $position $text]
  expect "its own text" [rules::san $position $move] $text
  set position [rules::make $position $move]
}
expect "opera" [rules::write $position] {1n1Rkb1r/p4ppp/4q3/4p1B1/4P3/8/PPP2PPP/2K5 b k - 1 17}
expect "opera's end" [lindex [rules::status $position {}] 1] {Checkmate: White wins}

exit [expr {$failures > 0}]
