#!/usr/bin/env bash
# What a program has recorded of its own Bullet world is opened by the commands for recordings.
# Usage: recorder_commands_test.sh WEFT PROGRAM
set -u
weft=$(realpath "$1") || exit 1
program=$(realpath "$2") || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

check() {  # check DESCRIPTION COMMAND...: the command must succeed
  "${@:2}" && return
  echo "FAILED: $1"
  cat out
  failures=$((failures + 1))
}
run() { timeout 60 "$@" >out 2>&1; }
says() { grep -qxF -- "$1" out; }

check "the program" run "$program"
hash=$(sed -n 's/^60 frames, content hash //p' out)
check "one file" [ "$(echo fall.*)" = fall.weftrec ]

check "info" run "$weft" info fall.weftrec
check "info: it is whole" says "fall.weftrec: finished recording of scene 'fall'"
check "info: no duration" says "  60 frames, t = 0.0166667 s to 1 s"
check "info: no time step" says "  engine a program's own loop, float32; frame interval 0.0166667 s"
check "info: cloth" says "  cloth 'cloth': 81 nodes, 128 faces"
check "info: ball" says "  rigid body 'ball': sphere, fixed"
check "info: event" says "  t = 0.5 s: half of the time is over"
check "info: hash" says "  content hash $hash"
check "info --json" run "$weft" info --json fall.weftrec
check "info --json: no time step" says '    "time_step_s": null,'
check "info --json: no duration" says '    "duration_s": null,'

check "verify" run "$weft" verify fall.weftrec
check "render" run "$weft" render fall.weftrec -o fall.png --style strain
check "render: a picture" [ -s fall.png ]
check "marks of every frame" python3 - <<'PY'
import sqlite3
db = sqlite3.connect("fall.weftrec")
assert db.execute("SELECT count(DISTINCT frame) FROM mark").fetchone()[0] == 60
assert {row[0] for row in db.execute("SELECT kind FROM mark")} == {"points", "arrows"}
PY
check "export" run "$weft" export --html fall.html fall.weftrec
check "export: a page" [ -s fall.html ]
check "trim" run "$weft" trim fall.weftrec -o part.weftrec --from "0.5 s"
check "trim: event" run "$weft" info part.weftrec
check "trim: event is kept" says "  t = 0.5 s: half of the time is over"
check "trim --error" run "$weft" trim fall.weftrec -o rounded.weftrec --error "0.1 mm"
check "trim --error: said" says "rounded: positions by at most 0.0001 m, velocities by at most 0.006 m/s"
check "trim --error: is smaller" [ "$(stat -c %s rounded.weftrec)" -lt "$(stat -c %s fall.weftrec)" ]
check "trim --error: is sound" run "$weft" verify rounded.weftrec
check "trim --error: provenance" run "$weft" info rounded.weftrec
check "trim --error: in the provenance" says "  rounded: positions by at most 0.0001 m, velocities by at most 0.006 m/s"
run "$weft" trim fall.weftrec -o no.weftrec --error "0 m"
check "trim --error: none" grep -q "position error = 0 \[m\], expected > 0" out
check "diff" run "$weft" diff fall.weftrec fall.weftrec

echo "$failures failures"
[ "$failures" -eq 0 ]
