# chess_panel.tcl: The panel of chess.tcl: a board of buttons, the game's moves, and the looks of
# pieces, board and light. chess.tcl reads it in a trusted world with a display. Only callbacks of Tk
# run here; nothing waits.

namespace eval panel {
  variable selected {}  ;# square of the selected piece
  variable promotion q
  variable file {}
  variable games {}     ;# games of the file, from pgn::read
  variable glyph {K \u265a Q \u265b R \u265c B \u265d N \u265e P \u265f}
  # The part whose look is edited. shaders: indices into the Script's fields shaders and materials.
  variable parts {{White pieces} {0 0} {Black pieces} {1 1} {Light squares} {2 2} {Dark squares} {3 3}}
  variable part {White pieces}
  variable kinds {Plastic Glass Marble Wood Metal}
  variable looks {} ;# part -> dict of color kind index roughness scale
  variable brightness 1.0
  variable ready 0
}

# --- The board ---

proc panel::press name {
  variable selected
  variable promotion
  set square [rules::square $name]
  set position [game::position]
  if {$selected ne {} && $square in [targets $selected]} {
    set piece [lindex $position 0 $selected]
    set text [rules::name $selected]$name
    if {$piece in {P p} && [string index $name 1] in {1 8}} {append text $promotion}
    set selected {}
    play $text [Browser now]
  } elseif {$square ne $selected && [rules::sideOf [lindex $position 0 $square]] eq [lindex $position 1]} {
    set selected $square
  } else {
    set selected {}
  }
  showBoard
}

proc panel::targets from {
  set found {}
  foreach move [rules::legal [game::position]] {if {[lindex $move 0] == $from} {lappend found [lindex $move 1]}}
  return $found
}

proc panel::showBoard {} {
  variable selected
  variable glyph
  set position [game::position]
  lassign $position board side
  set legal [expr {$selected eq {} ? {} : [targets $selected]}]
  lassign [lindex $game::history end 2] from to
  set king [expr {[rules::inCheck $position] ? [lsearch -exact $board [expr {$side eq "w" ? {K} : {k}}]] : -1}]
  foreach file {a b c d e f g h} {
    foreach rank {1 2 3 4 5 6 7 8} {
      set square [rules::square $file$rank]
      set piece [lindex $board $square]
      set dark [expr {($square % 10 + $square / 10) % 2 == 1}]
      set ground [expr {$dark ? {#9c6b45} : {#d8b483}}]
      if {$square eq $from || $square eq $to} {set ground [expr {$dark ? {#a99440} : {#d6c46a}}]}
      if {$square in $legal} {set ground [expr {$dark ? {#5d8f4e} : {#8cc07a}}]}
      if {$square eq $selected} {set ground #e0d060}
      if {$square == $king} {set ground #d06050}
      set text [expr {$piece eq "." ? { } : [dict get $glyph [string toupper $piece]]}]
      .board.$file$rank configure -text $text -background $ground -activebackground $ground \
        -foreground [expr {[rules::sideOf $piece] eq "w" ? {#fffbea} : {#20130c}}] \
        -activeforeground [expr {[rules::sideOf $piece] eq "w" ? {#ffffff} : {#402818}}]
    }
  }
}

# Called by the game after each change.
proc panel::refresh text {
  variable selected {}
  if {![llength [info commands .board]]} return ;# the window has been closed
  .status configure -text $text
  set rows {}
  foreach {white black} [game::sans] {lappend rows [format {%3d. %-8s %s} [expr {[llength $rows] + 1}] $white $black]}
  .tabs.game.moves delete 0 end
  .tabs.game.moves insert end {*}$rows
  .tabs.game.moves see end
  .tabs.game.buttons.back state [expr {[llength $game::history] > 1 ? {!disabled} : {disabled}}]
  .tabs.game.buttons.play configure -text [expr {$game::running ? {Pause} : {Play}}]
  showBoard
}

# --- The game ---

proc panel::reset {} {
  game::run 0 0
  game::reset
}
proc panel::back {} {
  game::run 0 0
  game::back [Browser now]
}
proc panel::step {} {
  game::run 0 0
  game::finish
  if {![game::step [Browser now]]} {.status configure -text "[.status cget -text] (no further move in this game)"}
}
proc panel::run {} {
  game::run [expr {!$game::running && [game::nextText] ne {}}] [Browser now]
  .tabs.game.buttons.play configure -text [expr {$game::running ? {Pause} : {Play}}]
}
proc panel::enter {} {
  set text [string trim [.tabs.game.enter.move get]]
  .tabs.game.enter.move delete 0 end
  if {$text ne {}} {play $text [Browser now]}
}

proc panel::ask {} {
  set types {{{Games of chess} {.pgn .PGN}} {{All files} *}}
  set name [tk_getOpenFile -title {Open a game} -filetypes $types -initialdir [file dirname [info script]]]
  if {$name ne {}} {openFile $name}
}
proc panel::openFile name {
  variable games
  if {[catch {
    set channel [open $name]
    set text [::read $channel 4000000]
    close $channel
    openText $text
  } why]} {
    .status configure -text "$name: $why"
  }
}
proc panel::openText text {
  variable games [pgn::read $text]
  if {![llength $games]} {error "no game in it"}
  variable source $text
  set names {}
  foreach game $games {
    set tags [dict merge {White ? Black ? Date {}} [lindex $game 0]]
    lappend names "[dict get $tags White] - [dict get $tags Black] [dict get $tags Date]"
  }
  .tabs.game.games configure -values $names
  .tabs.game.games current 0
  choose 0
}
proc panel::choose index {
  variable source
  game::run 0 0
  if {[catch {game::load $source $index} why]} {return [.status configure -text $why]}
  game::reset
}

# --- Looks ---

proc panel::indices {} {
  variable parts
  variable part
  dict get $parts $part
}

# Returns n and k of a metal with this reflectance (Gulbrandsen, JCGT 3(4), 2014), for an edge tint
# between the two extremes.
proc panel::metal reflectance {
  set r [expr {min(0.97, max(0.02, $reflectance))}]
  set n [expr {0.6 * (1 - $r) / (1 + $r) + 0.4 * (1 + sqrt($r)) / (1 - sqrt($r))}]
  list $n [expr {sqrt(max(0, ($r * ($n + 1) ** 2 - ($n - 1) ** 2) / (1 - $r)))}]
}

# Materials have display colours, shaders' options are linear.
proc panel::linear color {
  lmap x $color {format %.4g [expr {$x <= 0.04045 ? $x / 12.92 : (($x + 0.055) / 1.055) ** 2.4}]}
}

proc panel::options look {
  dict with look {}
  set color [linear $color]
  set scaled {{c f} {lmap x $c {format %.4g [expr {$x * $f}]}}}
  switch -- $kind {
    Plastic {list "1f index $index" "1f roughness $roughness"}
    Glass {
      list "1f index $index" "color absorption [lmap x $color {format %.4g [expr {2.5 * (1 - $x)}]}]"
    }
    Marble {list "color stone $color" "color vein [apply $scaled $color .35]" "1f veins $scale" "1f polish $index"}
    Wood {list "color light $color" "color dark [apply $scaled $color .45]" "1f rings $scale" "1f varnish $index"}
    Metal {
      set n {}
      set k {}
      foreach x $color {
        lassign [metal $x] a b
        lappend n [format %.4g $a]
        lappend k [format %.4g $b]
      }
      list "color n $n" "color k $k" "1f roughness $roughness"
    }
  }
}

# Applies the look of a part to the world.
proc panel::apply_ {} {
  variable looks
  variable part
  lassign [indices] shader material
  set look [dict get $looks $part]
  set node [lindex $::shaders $shader]
  [lindex $::materials $material] set diffuseColor [dict get $look color]
  $node set name [dict get $look kind]
  $node set file [string tolower [dict get $look kind]]
  $node set options [options $look]
}

proc panel::choosePart {} {
  variable looks
  variable part
  variable ready 0
  variable kind
  set look [dict get $looks $part]
  set w .tabs.looks
  foreach name {red green blue} value [dict get $look color] {$w.$name set $value}
  foreach name {index roughness scale} {$w.$name set [dict get $look $name]}
  set kind [dict get $look kind]
  swatch
  after 50 {set panel::ready 1} ;# scale widgets report the values they are set to
}
proc panel::swatch {} {
  variable looks
  variable part
  set color {}
  foreach x [dict get $looks $part color] {lappend color [expr {int(255 * $x + 0.5)}]}
  .tabs.looks.swatch configure -background [format #%02x%02x%02x {*}$color]
}
proc panel::changed args {
  variable ready
  variable looks
  variable part
  variable kind
  if {!$ready} return
  set w .tabs.looks
  dict set looks $part color [list [$w.red get] [$w.green get] [$w.blue get]]
  foreach name {index roughness scale} {dict set looks $part $name [$w.$name get]}
  dict set looks $part kind $kind
  swatch
  apply_
}
proc panel::lightChanged value {
  variable emission
  variable ready
  if {!$ready || [llength $::shaders] < 5} return
  set scaled [lmap x $emission {format %.4g [expr {$x * $value}]}]
  [lindex $::shaders 4] set options [list "color reflectance 0 0 0" "color emission $scaled"]
}

# --- The window ---

proc panel::makeGame w {
  ttk::frame $w -padding 6
  listbox $w.moves -height 14 -width 26 -font TkFixedFont -yscrollcommand [list $w.bar set] -activestyle none
  ttk::scrollbar $w.bar -command [list $w.moves yview]
  ttk::frame $w.buttons
  foreach {name text command} {reset |< reset back < back step > step play Play run} {
    ttk::button $w.buttons.$name -text $text -width 6 -command panel::$command
    pack $w.buttons.$name -side left -expand 1 -fill x
  }
  ttk::frame $w.enter
  ttk::label $w.enter.label -text {Move}
  ttk::entry $w.enter.move -width 10
  bind $w.enter.move <Return> panel::enter
  ttk::label $w.enter.promote -text {  Promote to}
  pack $w.enter.label $w.enter.move $w.enter.promote -side left
  foreach kind {q r b n} {
    ttk::radiobutton $w.enter.$kind -text [dict get $panel::glyph [string toupper $kind]] -value $kind -variable panel::promotion
    pack $w.enter.$kind -side left
  }
  ttk::combobox $w.games -state readonly
  bind $w.games <<ComboboxSelected>> {panel::choose [%W current]}
  ttk::button $w.open -text {Open a PGN file...} -command {coroutine panel::asking panel::ask}
  grid $w.games - -sticky ew -pady 2
  grid $w.moves $w.bar -sticky nsew
  grid $w.buttons - -sticky ew -pady 4
  grid $w.enter - -sticky ew
  grid $w.open - -sticky ew -pady 4
  grid rowconfigure $w 1 -weight 1
  grid columnconfigure $w 0 -weight 1
}

proc panel::makeLooks w {
  variable parts
  variable kinds
  variable looks
  variable emission {13 12 10.2}
  foreach {name indices} $parts {
    set color [[lindex $::materials [lindex $indices 1]] get diffuseColor]
    set options [[lindex $::shaders [lindex $indices 0]] get options]
    set look [dict create color $color kind Plastic index 1.5 roughness 0.1 scale 5]
    foreach option $options {
      if {[regexp {^1f (index|roughness) (\S+)$} $option -> key value]} {dict set look $key $value}
    }
    dict set looks $name $look
  }
  if {[llength $::shaders] > 4} {
    foreach option [[lindex $::shaders 4] get options] {
      if {[regexp {^color emission (.*)$} $option -> value]} {set emission $value}
    }
  }
  ttk::frame $w -padding 6
  ttk::combobox $w.part -state readonly -values [dict keys $parts] -textvariable panel::part
  bind $w.part <<ComboboxSelected>> panel::choosePart
  ttk::combobox $w.kind -state readonly -values $kinds -textvariable panel::kind
  bind $w.kind <<ComboboxSelected>> panel::changed
  frame $w.swatch -height 24 -relief sunken -borderwidth 1
  grid $w.part - -sticky ew -pady 2
  grid $w.kind - -sticky ew -pady 2
  grid $w.swatch - -sticky ew -pady 2
  foreach {name text from to step} {
    red Red 0 1 0.01 green Green 0 1 0.01 blue Blue 0 1 0.01 index {Index of refraction} 1 2.5 0.01 roughness Roughness 0 0.6 0.01
    scale {Veins, rings} 0.5 20 0.5
  } {
    ttk::label $w.${name}Label -text $text
    scale $w.$name -from $from -to $to -resolution $step -orient horizontal -command panel::changed -length 150
    grid $w.${name}Label $w.$name -sticky sew
  }
  ttk::label $w.lightLabel -text {Light}
  scale $w.light -from 0 -to 3 -resolution 0.05 -orient horizontal -variable panel::brightness -command panel::lightChanged
  grid $w.lightLabel $w.light -sticky sew
  grid columnconfigure $w 1 -weight 1
}

proc panel::make {} {
  wm title . Chess
  wm resizable . 0 0
  frame .board -borderwidth 4 -background #5a3420
  set row 0
  foreach rank {8 7 6 5 4 3 2 1} {
    label .board.r$rank -text $rank -background #5a3420 -foreground #e8d0a8
    set line [list .board.r$rank]
    foreach file {a b c d e f g h} {
      button .board.$file$rank -font {{DejaVu Sans} 26} -width 2 -relief flat -borderwidth 0 -highlightthickness 0 \
        -padx 0 -pady 2 -command [list panel::press $file$rank] -takefocus 0
      lappend line .board.$file$rank
    }
    grid {*}$line -sticky nsew
  }
  set line [list x]
  foreach file {a b c d e f g h} {
    label .board.f$file -text $file -background #5a3420 -foreground #e8d0a8
    lappend line .board.f$file
  }
  grid {*}$line -sticky nsew
  for {set i 0} {$i < 8} {incr i} {grid rowconfigure .board $i -weight 1 -uniform square}
  ttk::notebook .tabs
  makeGame .tabs.game
  makeLooks .tabs.looks
  .tabs add .tabs.game -text Game
  .tabs add .tabs.looks -text Looks
  ttk::label .status -anchor w -padding {6 3}
  grid .board .tabs -sticky nsew
  grid .status - -sticky ew
  lappend game::observers panel::refresh
  set tags {[White "Morphy"] [Black "Brunswick, Isouard"] [Date "1858"]}
  openText [expr {[llength $::game] ? [join $::game \n] : "$tags $game::opera"}]
  choosePart
}

panel::make
