# joints.tcl: moves a joint of a robot that vv shows, prints the events of the joint, and saves a
# picture. A client of vv's control channel sends lines of JSON to a socket and reads the answers
# (docs/control.md); it can be written in any language.
#
#   vv examples/robots/arm.wrl --control 127.0.0.1:7450
#   tclsh joints.tcl 127.0.0.1 7450 arm.png

lassign $argv host port file
set vv [socket $host $port]
fconfigure $vv -buffering line -encoding utf-8 -translation lf
set last 0

# Sends a command and returns the answer. Events that come before it are printed.
proc command {members} {
  global vv last
  puts $vv "{\"id\":[incr last],$members}"
  while {[gets $vv line] >= 0} {
    if {[string match "*\"event\":*" $line]} {
      puts $line
    } elseif {[string match "*\"error\":*" $line]} {
      error $line
    } else {
      return $line
    }
  }
  error "vv has ended the connection"
}

command {"command":"subscribe","node":"J2","field":"rotation"}
foreach angle {-0.1 -0.2 -0.3 -0.4 -0.5} {
  command [format {"command":"set","node":"J2","field":"rotation","value":[0,0,1,%s]} $angle]
}
command [format {"command":"render","size":[160,120],"samples":16,"file":"%s"} $file]
