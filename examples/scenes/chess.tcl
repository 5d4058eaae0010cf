# chess.tcl: Moves the pieces of chess.wrl. It implements the rules, reads games (PGN), and plays
# one by the world's clock. In a trusted world with a display it opens a panel instead
# (chess_panel.tcl) and waits for the user. It is one file, because programs of untrusted worlds
# cannot read a second one.
#
# A position is a list {board side castling enPassant halfmoves moveNumber}. The board has 12 rows of
# 10, with a margin of #, so that no step leaves it: a1 is 21, h1 28, a8 91, h8 98. PNBRQK are
# White's pieces, pnbrqk Black's, a dot is an empty square.

namespace eval rules {
  variable start {rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR w KQkq - 0 1}
  variable knight {-21 -19 -12 -8 8 12 19 21}
  variable straight {-10 -1 1 10}
  variable diagonal {-11 -9 9 11}
  variable around [concat $straight $diagonal]
  # Castling rights that are lost by a move from or to a square.
  variable rights {25 KQ 21 Q 28 K 95 kq 91 q 98 k}
  namespace export *
}

proc rules::square name {
  if {![regexp {^([a-h])([1-8])$} $name -> file rank]} {error "no square: $name"}
  expr {11 + [scan $file %c] - 97 + 10 * $rank}
}
proc rules::name square {format %c%d [expr {96 + $square % 10}] [expr {$square / 10 - 1}]}
proc rules::sideOf piece {expr {$piece eq "." || $piece eq "#" ? {} : [string is upper $piece] ? {w} : {b}}}
proc rules::other side {expr {$side eq "w" ? {b} : {w}}}

# --- Positions as text (FEN) ---

proc rules::read fen {
  set fields [concat $fen [lrange {- w - - 0 1} [llength $fen] 5]]
  lassign $fields placement side castling enPassant half full
  set board [lrepeat 120 #]
  set rows [split $placement /]
  if {[llength $rows] != 8 || $side ni {w b}} {error "no position: $fen"}
  for {set rank 7} {$rank >= 0} {incr rank -1} {
    set row [string map {1 . 2 .. 3 ... 4 .... 5 ..... 6 ...... 7 ....... 8 ........} [lindex $rows [expr {7 - $rank}]]]
    if {![regexp {^[.PNBRQKpnbrqk]{8}$} $row]} {error "no position: $fen"}
    for {set file 0} {$file < 8} {incr file} {lset board [expr {21 + $file + 10 * $rank}] [string index $row $file]}
  }
  if {[llength [lsearch -all -exact $board K]] != 1 || [llength [lsearch -all -exact $board k]] != 1} {error "no two kings: $fen"}
  list $board $side [expr {$castling eq "-" ? {} : $castling}] [expr {$enPassant eq "-" ? 0 : [square $enPassant]}] $half $full
}

proc rules::write position {
  lassign $position board side castling enPassant half full
  set rows {}
  for {set rank 7} {$rank >= 0} {incr rank -1} {
    set row [join [lrange $board [expr {21 + 10 * $rank}] [expr {28 + 10 * $rank}]] {}]
    lappend rows [string map {........ 8 ....... 7 ...... 6 ..... 5 .... 4 ... 3 .. 2 . 1} $row]
  }
  list [join $rows /] $side [expr {$castling eq {} ? {-} : $castling}] [expr {$enPassant ? [name $enPassant] : {-}}] $half $full
}

# --- Moves: {from to promotion}; promotion is empty or one of q r b n ---

# Returns whether a piece of this side attacks the square.
proc rules::attacked {board square side} {
  variable knight
  variable straight
  variable diagonal
  variable around
  if {$side eq "w"} {
    lassign {P N B R Q K -9 -11} pawn horse bishop rook queen king left right
  } else {
    lassign {p n b r q k 9 11} pawn horse bishop rook queen king left right
  }
  if {[lindex $board [expr {$square + $left}]] eq $pawn || [lindex $board [expr {$square + $right}]] eq $pawn} {return 1}
  foreach step $knight {if {[lindex $board [expr {$square + $step}]] eq $horse} {return 1}}
  foreach step $around {if {[lindex $board [expr {$square + $step}]] eq $king} {return 1}}
  foreach {steps slider} [list $straight $rook $diagonal $bishop] {
    foreach step $steps {
      set at [expr {$square + $step}]
      while {[set piece [lindex $board $at]] eq "."} {incr at $step}
      if {$piece eq $slider || $piece eq $queen} {return 1}
    }
  }
  return 0
}

proc rules::inCheck {position {side {}}} {
  lassign $position board turn
  if {$side eq {}} {set side $turn}
  attacked $board [lsearch -exact $board [expr {$side eq "w" ? {K} : {k}}]] [other $side]
}

# Returns all pseudo-legal moves: they may leave the king in check.
proc rules::pseudo position {
  variable knight
  variable straight
  variable diagonal
  variable around
  lassign $position board side castling enPassant
  set own [expr {$side eq "w" ? {[PNBRQK]} : {[pnbrqk]}}]
  set foe [expr {$side eq "w" ? {[pnbrqk]} : {[PNBRQK]}}]
  set moves {}
  foreach from [lsearch -all -regexp $board $own] {
    set piece [string tolower [lindex $board $from]]
    switch -- $piece {
      p {
        set ahead [expr {$side eq "w" ? 10 : -10}]
        set to [expr {$from + $ahead}]
        set row [expr {$from / 10 - 1}]
        set last [expr {$row == ($side eq "w" ? 7 : 2)}]
        set targets {}
        if {[lindex $board $to] eq "."} {
          lappend targets $to
          set second [expr {$to + $ahead}]
          if {$row == ($side eq "w" ? 2 : 7) && [lindex $board $second] eq "."} {lappend targets $second}
        }
        foreach step {-1 1} {
          set to [expr {$from + $ahead + $step}]
          if {[string match $foe [lindex $board $to]] || ($enPassant && $to == $enPassant)} {lappend targets $to}
        }
        foreach to $targets {
          if {$last} {
            foreach promotion {q r b n} {lappend moves [list $from $to $promotion]}
          } else {
            lappend moves [list $from $to {}]
          }
        }
        continue
      }
      n {set steps $knight; set far 0}
      b {set steps $diagonal; set far 1}
      r {set steps $straight; set far 1}
      q {set steps $around; set far 1}
      k {set steps $around; set far 0}
    }
    foreach step $steps {
      set to [expr {$from + $step}]
      while {[lindex $board $to] eq "."} {
        lappend moves [list $from $to {}]
        if {!$far} break
        incr to $step
      }
      if {[string match $foe [lindex $board $to]]} {lappend moves [list $from $to {}]}
    }
  }
  if {$castling ne {}} {
    foreach {side_ right king free} {w K 25 {26 27} w Q 25 {24 23 22} b k 95 {96 97} b q 95 {94 93 92}} {
      if {$side_ ne $side || [string first $right $castling] < 0} continue
      set clear 1
      foreach square $free {if {[lindex $board $square] ne "."} {set clear 0}}
      foreach square [list $king {*}[lrange $free 0 1]] {
        if {$clear && [attacked $board $square [other $side]]} {set clear 0}
      }
      if {$clear} {lappend moves [list $king [lindex $free 1] {}]}
    }
  }
  return $moves
}

# Returns the position after a move, which is not checked against the rules.
proc rules::make {position move} {
  variable rights
  lassign $position board side castling enPassant half full
  lassign $move from to promotion
  set piece [lindex $board $from]
  set taken [lindex $board $to]
  lset board $from .
  lset board $to $piece
  incr half
  set next 0
  if {$piece eq "P" || $piece eq "p"} {
    set half 0
    set ahead [expr {$side eq "w" ? 10 : -10}]
    if {$to == $enPassant && $enPassant} {lset board [expr {$to - $ahead}] .}
    if {$to - $from == 2 * $ahead} {set next [expr {$from + $ahead}]}
    if {$promotion ne {}} {lset board $to [expr {$side eq "w" ? [string toupper $promotion] : $promotion}]}
  } elseif {($piece eq "K" || $piece eq "k") && abs($to - $from) == 2} {
    set corner [expr {$to > $from ? $from + 3 : $from - 4}]
    lset board [expr {($from + $to) / 2}] [lindex $board $corner]
    lset board $corner .
  }
  if {$taken ne "."} {set half 0}
  if {$castling ne {}} {
    foreach square [list $from $to] {
      if {[dict exists $rights $square]} {
        foreach right [split [dict get $rights $square] {}] {set castling [string map [list $right {}] $castling]}
      }
    }
  }
  if {$side eq "b"} {incr full}
  list $board [other $side] $castling $next $half $full
}

proc rules::leavesKing {position move} {inCheck [make $position $move] [lindex $position 1]}

proc rules::legal position {
  set moves {}
  foreach move [pseudo $position] {if {![leavesKing $position $move]} {lappend moves $move}}
  return $moves
}

proc rules::perft {position depth} {
  if {$depth == 0} {return 1}
  set moves [legal $position]
  if {$depth == 1} {return [llength $moves]}
  set count 0
  foreach move $moves {incr count [perft [make $position $move] [expr {$depth - 1}]]}
  return $count
}

# Returns a key that is equal for positions that count as repeated. An en passant square counts only
# if a capture there is possible.
proc rules::key position {
  lassign $position board side castling enPassant
  set possible 0
  if {$enPassant} {
    foreach move [legal $position] {
      lassign $move from to
      if {$to == $enPassant && [lindex $board $from] in {P p}} {set possible 1}
    }
  }
  list $board $side $castling [expr {$possible ? $enPassant : 0}]
}

# Returns whether neither side has enough material to mate.
proc rules::isDead board {
  set men [string map {# {} . {} K {} k {}} [join $board {}]]
  expr {$men eq {} || [regexp {^[NBnb]$} $men]}
}

# Returns {over text}: whether the game has ended, and a description of the state. keys: keys of all
# positions of the game so far.
proc rules::status {position keys} {
  lassign $position board side castling enPassant half
  set who [expr {$side eq "w" ? {White} : {Black}}]
  set check [inCheck $position]
  if {[llength [legal $position]] == 0} {
    if {!$check} {return {1 {Stalemate: a draw}}}
    return [list 1 "Checkmate: [expr {$side eq {w} ? {Black} : {White}}] wins"]
  }
  if {[isDead $board]} {return {1 {A draw: neither side can win}}}
  set text "$who to move[expr {$check ? {, in check} : {}}]"
  set times [llength [lsearch -all -exact $keys [key $position]]]
  if {$times >= 5} {return {1 {A draw: the same position for the fifth time}}}
  if {$half >= 150} {return {1 {A draw: 75 moves without a capture or a pawn's move}}}
  if {$times >= 3} {append text {; a draw can be claimed: threefold repetition}}
  if {$half >= 100} {append text {; a draw can be claimed: fifty moves}}
  list 0 $text
}

# --- Moves as text ---

proc rules::san {position move} {
  lassign $position board side
  lassign $move from to promotion
  set piece [string toupper [lindex $board $from]]
  set takes [expr {[lindex $board $to] ne "." || ($piece eq "P" && ($to - $from) % 10 != 0)}]
  if {$piece eq "K" && abs($to - $from) == 2} {
    set text [expr {$to > $from ? {O-O} : {O-O-O}}]
  } elseif {$piece eq "P"} {
    set text [expr {$takes ? "[string index [name $from] 0]x" : {}}][name $to]
    if {$promotion ne {}} {append text =[string toupper $promotion]}
  } else {
    set file 0
    set rank 0
    set others 0
    foreach other [pseudo $position] {
      lassign $other from2 to2
      if {$to2 != $to || $from2 == $from || [lindex $board $from2] ne [lindex $board $from]} continue
      if {[leavesKing $position $other]} continue
      incr others
      if {$from2 % 10 == $from % 10} {incr file}
      if {$from2 / 10 == $from / 10} {incr rank}
    }
    set where {}
    if {$others} {
      set where [expr {!$file ? [string index [name $from] 0] : !$rank ? [string index [name $from] 1] : [name $from]}]
    }
    set text $piece$where[expr {$takes ? {x} : {}}][name $to]
  }
  set after [make $position $move]
  if {[inCheck $after]} {append text [expr {[llength [legal $after]] ? {+} : {#}}]}
  return $text
}

# Returns the legal move for a text: SAN (Nbd7, exd8=Q+, O-O) or squares (e2e4, e7e8q). Raises an
# error unless exactly one move matches.
proc rules::find {position text} {
  lassign $position board side
  set plain [string map {0-0-0 O-O-O 0-0 O-O} [regsub {[+#!?]*(e\.p\.)?$} [string trim $text] {}]]
  set meant {}
  foreach move [pseudo $position] {
    lassign $move from to promotion
    set piece [string toupper [lindex $board $from]]
    if {$plain in {O-O O-O-O}} {
      if {$piece eq "K" && $to - $from == ($plain eq "O-O" ? 2 : -2)} {lappend meant $move}
    } elseif {[regexp {^([a-h][1-8])-?([a-h][1-8])=?([qrbnQRBN]?)$} $plain -> a b into]} {
      if {[name $from] eq $a && [name $to] eq $b && $promotion eq [string tolower $into]} {lappend meant $move}
    } elseif {[regexp {^([KQRBNP]?)([a-h]?)([1-8]?)[x:-]?([a-h][1-8])=?\(?([QRBN]?)\)?$} $plain -> kind file rank target into]} {
      if {$piece eq ($kind eq {} ? {P} : $kind) && [name $to] eq $target && $promotion eq [string tolower $into] &&
          [string match $file* [name $from]] && [string match *$rank [name $from]]} {lappend meant $move}
    } else {
      error "no move: $text"
    }
  }
  set found [lmap move $meant {if {[leavesKing $position $move]} continue; set move}]
  if {[llength $found] == 0} {error "illegal move: $text"}
  if {[llength $found] > 1} {error "ambiguous move: $text"}
  lindex $found 0
}

# --- Games as text (PGN): a list of games {tags moves result}, without comments, variations and
# annotations ---

namespace eval pgn {}
proc pgn::read text {
  set games {}
  set tags {}
  set moves {}
  set depth 0
  set at 0
  set end [string length $text]
  while {$at < $end} {
    set rest [string range $text $at [expr {$at + 20000}]]
    if {[regexp {\A\s+} $rest all]} {
    } elseif {($at == 0 || [string index $text $at-1] eq "\n") && [regexp {\A%[^\n]*} $rest all]} {
    } elseif {[regexp {\A\{[^\}]*\}} $rest all] || [regexp {\A;[^\n]*} $rest all] || [regexp {\A\$[0-9]+} $rest all]} {
    } elseif {[regexp {\A\(} $rest all]} {
      incr depth
    } elseif {[regexp {\A\)} $rest all]} {
      if {[incr depth -1] < 0} {error "PGN: \")\" without \"(\""}
    } elseif {$depth == 0 && [regexp {\A\[\s*(\w+)\s*"((?:[^"\\]|\\.)*)"\s*\]} $rest all tag value]} {
      if {[llength $moves]} {
        lappend games [list $tags $moves *]
        set tags {}
        set moves {}
      }
      dict set tags $tag [string map {\\\" \" \\\\ \\} $value]
    } elseif {[regexp {\A(1-0|0-1|1/2-1/2|\*)} $rest all]} {
      if {$depth == 0} {
        lappend games [list $tags $moves $all]
        set tags {}
        set moves {}
      }
    } elseif {[regexp {\A[0-9]+\s*\.+} $rest all] || [regexp {\A[0-9]+(?=\s)} $rest all] || [regexp {\A[!?]+} $rest all]} {
    } elseif {[regexp {\A[A-Za-z0][-A-Za-z0-9=+#!?:]*} $rest all]} {
      if {$depth == 0 && $all ni {e.p. ep}} {lappend moves $all}
    } else {
      error "PGN: cannot read \"[string range $rest 0 20]\""
    }
    incr at [string length $all]
  }
  if {[llength $moves] || [dict size $tags]} {lappend games [list $tags $moves *]}
  return $games
}

# --- The current game ---

# history: a list of {position key move san layout} for each position so far; layout: a dict from
# nodes to their places.
namespace eval game {
  variable history {}
  variable line {}    ;# moves of the game that is played, as text
  variable running 0  ;# true while it plays them by itself
  variable nextAt 0   ;# time of the next move
  variable waiting {} ;# moves that arrived during another one
  variable motion {}  ;# {start {node kind from to delay} ...}: moving pieces
  variable dressed {} ;# promoted pawns: node -> previous children
  variable moveTime 0.85
  variable pause 0.4
  variable observers {} ;# called after each change
  # Paul Morphy against Duke Karl and Count Isouard, Paris 1858.
  variable opera {
    1. e4 e5 2. Nf3 d6 3. d4 Bg4 4. dxe5 Bxf3 5. Qxf3 dxe5 6. Bc4 Nf6 7. Qb3 Qe7 8. Nc3 c6 9. Bg5 b5 10. Nxb5 cxb5
    11. Bxb5+ Nbd7 12. O-O-O Rd8 13. Rxd7 Rxd7 14. Rd1 Qe6 15. Bxd7+ Nxd7 16. Qb8+ Nxb8 17. Rd8# 1-0
  }
}

proc game::place square {list [expr {$square % 10 - 4.5}] 0.0 [expr {5.5 - $square / 10}]}

# Returns a place beside the board, to the right of White; White's men are nearer to White. n: number
# of men of this side there.
proc game::besidePlace {side n} {
  set z [expr {4.1 - 0.74 * ($n / 3)}]
  list [expr {5.15 + 0.73 * ($n % 3)}] 0.0 [expr {$side eq "w" ? $z : -$z}]
}

proc game::position {} {lindex $game::history end 0}
proc game::layout {} {lindex $game::history end 4}

proc game::reset {} {
  variable history
  variable waiting {}
  variable motion {}
  variable dressed
  dict for {node children} $dressed {$node set children $children}
  set dressed {}
  set layout {}
  set order {}
  foreach rank {1 2 7 8} {foreach file {a b c d e f g h} {lappend order [rules::square $file$rank]}}
  foreach node $::pieces square $order {dict set layout $node [list $square [place $square]]}
  foreach node $::spares where $game::sparePlaces {dict set layout $node [list {} $where]}
  set position [rules::read $rules::start]
  if {[llength $history]} {show [layout] $layout}
  set history [list [list $position [rules::key $position] {} {} $layout]]
  tell
}

proc game::nodeAt {layout square} {
  dict for {node where} $layout {if {[lindex $where 0] == $square && [lindex $where 0] ne {}} {return $node}}
  error "no piece on [rules::name $square]"
}

# Returns the layout after a legal move. Captured pieces go beside the board.
proc game::after {layout position move} {
  lassign $position board side castling enPassant
  lassign $move from to promotion
  set node [nodeAt $layout $from]
  set piece [lindex $board $from]
  set victim {}
  if {[lindex $board $to] ne "."} {
    set victim $to
  } elseif {$piece in {P p} && $enPassant && $to == $enPassant} {
    set victim [expr {$side eq "w" ? $to - 10 : $to + 10}]
  }
  if {$victim ne {}} {
    set other [rules::other $side]
    dict set layout [nodeAt $layout $victim] [list {} [besidePlace $other [taken $layout $other]]]
  }
  dict set layout $node [list $to [place $to]]
  if {$piece in {K k} && abs($to - $from) == 2} {
    set rook [nodeAt $layout [expr {$to > $from ? $from + 3 : $from - 4}]]
    set beside [expr {($from + $to) / 2}]
    dict set layout $rook [list $beside [place $beside]]
  }
  if {$promotion ne {}} {
    set index [expr {[lsearch {q r b n} $promotion] + ($side eq "w" ? 0 : 4)}]
    set spare [lindex $::spares $index]
    if {[lindex [dict get $layout $spare] 0] eq {} && [dict get $layout $spare] eq [list {} [lindex $game::sparePlaces $index]]} {
      dict set layout $spare [list $to [place $to]]
      dict set layout $node [list {} [lindex $game::sparePlaces $index]] ;# the two change places
    } else {
      dress $node $spare ;# only one spare piece of each kind exists
    }
  }
  return $layout
}

# Returns the number of men of a side beside the board.
proc game::taken {layout side} {
  set count 0
  set half [expr {$side eq "w" ? 1 : -1}]
  dict for {node where} $layout {
    lassign [lindex $where 1] x y z
    if {[lindex $where 0] eq {} && $x > 4.8 && $z * $half > 0} {incr count}
  }
  return $count
}

proc game::dress {node like} {
  variable dressed
  if {![dict exists $dressed $node]} {dict set dressed $node [$node get children]}
  $node set children [$like get children]
}

# Moves all pieces to their places at once.
proc game::show {before after} {
  dict for {node where} $after {
    if {![dict exists $before $node] || [dict get $before $node] ne $where} {$node set translation [lindex $where 1]}
  }
}

# Starts moving the pieces to their places. when: the start time.
proc game::setOut {before after mover when} {
  variable motion
  finish
  set motion [list $when]
  dict for {node where} $after {
    set old [dict get $before $node]
    if {$old eq $where} continue
    lassign [lindex $old 1] x1 y1 z1
    lassign [lindex $where 1] x2 y2 z2
    set dx [expr {abs($x2 - $x1)}]
    set dz [expr {abs($z2 - $z1)}]
    set straight [expr {$dx < 0.01 || $dz < 0.01 || abs($dx - $dz) < 0.01}]
    if {[lindex $old 0] eq {} || [lindex $where 0] eq {}} {
      lappend motion [list $node 1.9 [lindex $old 1] [lindex $where 1] 0.12] ;# above the others, to or from a place beside the board
    } elseif {!$straight || $node ne $mover} {
      lappend motion [list $node 1.7 [lindex $old 1] [lindex $where 1] 0.0] ;# a knight, or a rook over its king
    } else {
      lappend motion [list $node 0.0 [lindex $old 1] [lindex $where 1] 0.0]
    }
  }
}

proc game::finish {} {
  variable motion
  foreach item [lrange $motion 1 end] {[lindex $item 0] set translation [lindex $item 3]}
  set motion {}
}

proc game::animate time {
  variable motion
  variable moveTime
  if {![llength $motion]} return
  set f [expr {($time - [lindex $motion 0]) / $moveTime}]
  if {$f >= 1} {return [finish]}
  foreach item [lrange $motion 1 end] {
    lassign $item node height from to delay
    set g [expr {min(1.0, max(0.0, ($f - $delay) / (1 - $delay)))}]
    set s [expr {$g * $g * (3 - 2 * $g)}]
    set place {}
    foreach a $from b $to {lappend place [expr {$a + $s * ($b - $a)}]}
    lset place 1 [expr {$height * 4 * $g * (1 - $g) * ($height > 1.8 ? 1 : 0.6)}]
    $node set translation $place
  }
}

# Plays a move now; its text is in the syntax of rules::find.
proc game::move {text when} {
  variable history
  set position [position]
  set move [rules::find $position $text]
  set san [rules::san $position $move]
  set before [layout]
  set layout [after $before $position $move]
  setOut $before $layout [nodeAt $before [lindex $move 0]] $when
  set next [rules::make $position $move]
  lappend history [list $next [rules::key $next] $move $san $layout]
  tell
}

proc game::keys {} {lmap entry $game::history {lindex $entry 1}}
proc game::sans {} {lmap entry [lrange $game::history 1 end] {lindex $entry 3}}
proc game::isOver {} {lindex [rules::status [position] [keys]] 0}

# Returns the next move of the played line, if the game has followed the line so far.
proc game::nextText {} {
  variable line
  variable history
  set played [expr {[llength $history] - 1}]
  if {$played >= [llength $line]} {return {}}
  foreach text [lrange $line 0 [expr {$played - 1}]] san [sans] {
    if {[bare $text] ne [bare $san]} {return {}}
  }
  lindex $line $played
}
proc game::bare text {string map {+ {} # {} ! {} ? {} = {} 0-0-0 O-O-O 0-0 O-O} $text}

proc game::step when {
  set text [nextText]
  if {$text eq {}} {return 0}
  if {[catch {move $text $when} why]} {
    say $why
    set game::running 0
    return 0
  }
  return 1
}

proc game::back when {
  variable history
  variable dressed
  variable waiting {}
  if {[llength $history] < 2} return
  set before [layout]
  set move [lindex $history end 2]
  set history [lrange $history 0 end-1]
  set node [nodeAt [layout] [lindex $move 0]]
  if {[lindex $move 2] ne {} && [dict exists $dressed $node]} {
    $node set children [dict get $dressed $node]
    dict unset dressed $node
  }
  setOut $before [layout] $node $when
  tell
}

# Starts another game from PGN or from moves alone. The moves are checked before anything changes.
proc game::load {text {index 0}} {
  lassign [lindex [pgn::read $text] $index] tags moves
  if {[dict exists $tags FEN]} {error "a game that begins with another position: the pieces of this set begin at home"}
  set position [rules::read $rules::start]
  set line {}
  foreach move $moves {
    set found [rules::find $position $move]
    lappend line [rules::san $position $found]
    set position [rules::make $position $found]
  }
  set game::line $line
  return $tags
}

proc game::say text {
  set ::status $text
  foreach observer $game::observers {{*}$observer $text}
}
proc game::tell {} {
  set ::position [rules::write [position]]
  say [lindex [rules::status [position] [keys]] 1]
}

proc game::run {on when} {
  set game::running $on
  set game::nextAt $when
}

# Advances the time: moves pieces, and starts the next move of a game that plays by itself. Moves
# start at their due time, independently of the frame rate.
proc game::tick time {
  variable running
  variable nextAt
  variable waiting
  variable motion
  variable moveTime
  variable pause
  for {set i 0} {$i < 50} {incr i} {
    set free [expr {![llength $motion] || $time >= [lindex $motion 0] + $moveTime}]
    if {!$free} break
    if {[llength $waiting]} {
      set when [expr {[llength $motion] ? [lindex $motion 0] + $moveTime : $time}]
      set waiting [lassign $waiting text]
      if {[catch {move $text $when} why]} {say $why}
    } elseif {$running && $time >= $nextAt} {
      set when $nextAt
      set nextAt [expr {$nextAt + $moveTime + $pause}]
      if {![step $when]} {set running 0}
    } else {
      break
    }
  }
  animate $time
}

# --- Procedures called by chess.wrl ---

proc initialize time {
  set ::game::sparePlaces [lmap node $::spares {$node get translation}]
  game::reset
  set text [expr {[llength $::game] ? [join $::game \n] : $game::opera}]
  if {[catch {game::load $text} why]} {
    puts "this game cannot be played: $why"
    game::load $game::opera
  }
  if {[catch {package require Tk}]} {
    game::run 1 [expr {$time + 1.0}]
  } elseif {[catch {source [file join [file dirname [info script]] chess_panel.tcl]} why]} {
    puts "no panel: $why"
    game::run 1 [expr {$time + 1.0}]
  }
}

proc play {text time} {
  set game::running 0
  lappend game::waiting $text
  game::tick $time
}

proc next {value time} {
  game::finish
  game::step $time
}

proc tick {time timestamp} {game::tick $timestamp}
