#!/usr/bin/env bash
# Makes pictures of a KiCad board with vv: top, bottom, three quarters, and a turntable if one is
# asked for. The GitHub Action beside this file and contrib/kibot call it; it runs alone, too:
#
#   board-pictures.sh BOARD OUTPUT [OPTIONS OF VV...]
#
# BOARD is a .wrl that KiCad has exported with relative models, a .glb, or a .kicad_pcb, which kicad-cli
# (KiCad 8 or later) exports first. OUTPUT is a .png; its folder is made if it is missing. Change
# VIEWS, SIZE and TURNTABLE (number of pictures; 0: none) in the environment.
set -euo pipefail

if [ $# -lt 2 ]; then
  echo "usage: $0 BOARD OUTPUT [OPTIONS OF VV...]" >&2
  exit 2
fi
board=$1 output=$2
shift 2
views=${VIEWS:-above,top,bottom}
views=${views// /} size=${SIZE:-800x600} turntable=${TURNTABLE:-0}
if [ ! -f "$board" ]; then
  echo "$0: $board: there is no such board" >&2
  exit 3
fi
mkdir -p -- "$(dirname -- "$output")"

options=()
case $board in
*.kicad_pcb)
  scratch=$(mktemp -d)
  trap 'rm -rf "$scratch"' EXIT
  export=$scratch/$(basename -- "$board" .kicad_pcb).wrl
  kicad-cli pcb export vrml --units mm --models-dir shapes3D --models-relative \
    -o "$export" "$board"
  # A vv.toml beside the board is for its exports, too.
  config=$(dirname -- "$board")/vv.toml
  if [ -f "$config" ]; then options+=(--config "$config"); fi
  board=$export
  ;;
esac

outputs=(-o "$output")
if [ "$turntable" != 0 ]; then
  outputs+=(-o "${output%.*}.gif" --turntable "$turntable")
fi
vv "$board" ${options[@]+"${options[@]}"} --preset pcb --from "$views" --size "$size" "${outputs[@]}" "$@"
