#!/usr/bin/env bash
# The commands for recordings: info, diff, trim, verify. Texts, exit codes, files left behind.
# Usage: recording_commands_test.sh WEFT
weft=$1
source "$(dirname -- "${BASH_SOURCE[0]}")/command_checks.sh"
time_limit=60

says() { grep -qF -- "$1" out; }
one_line() { [ "$(wc -l <err)" -eq 1 ] && grep -qF -- "$1" err; }

json() {  # json EXPRESSION: a Python expression about the array that is in the file out
  python3 -c "import json, sys; r = json.load(open('out')); sys.exit(0 if ($1) else 1)"
}

# A recording of every kind: whole, blown up, partial with its log, damaged, cut off, foreign
check "a run" exits 0 run drape_sphere -e reference --duration "0.6 s" -o a.weftrec
hash=$(sed -n 's/^content hash //p' out)
check "a run that blows up" exits 1 run drape_sphere --integrator explicit_euler -o blown.weftrec
"$weft" run hang -e reference -o stopped.weftrec --duration "1000 s" >out 2>err &
run=$!
log_size() { stat -c %s stopped.partial.weftrec-wal 2>/dev/null || echo 0; }
while [ "$(log_size)" -lt 2500000 ] && kill -0 $run; do sleep 0.01; done  # several commits
kill -KILL $run
wait $run 2>/dev/null
head -c 100000 a.weftrec >cut.weftrec
echo "a text" >text.weftrec
mkfifo pipe.weftrec
: >empty.weftrec
python3 - <<'PYTHON'
import sqlite3
sqlite3.connect("foreign.weftrec").executescript("CREATE TABLE t (x)")
PYTHON

# What every command says of a file that is no recording
unreadable=(gone.weftrec "no such file" cut.weftrec "truncated, 100000 of " text.weftrec "not a Weft recording"
  pipe.weftrec "pipe.weftrec: " empty.weftrec "is empty" foreign.weftrec "another application's database" . ".: ")
refuses() {  # refuses COMMAND with the file put after it
  local i
  for ((i = 0; i < ${#unreadable[@]}; i += 2)); do
    check "$1 ${unreadable[i]}" exits 2 "$1" "${unreadable[i]}" "${@:2}"
    check "$1 ${unreadable[i]}: names the file" one_line "weft: ${unreadable[i]}: "
    check "$1 ${unreadable[i]}: says why" one_line "${unreadable[i + 1]}"
  done
}

# info
refuses info
check "info" exits 0 info a.weftrec
for text in "a.weftrec: finished recording of scene 'drape_sphere'" "  16 frames, t = 0 s to 0.6 s of 0.6 s" \
  "  engine reference, float64; time step 0.01 s, frame interval 0.04 s" "  cloth 'cloth': 2500 nodes, 4802 faces" \
  "  rigid body 'ball': sphere, fixed" "  weft: " "  format version 1, " "  content hash $hash"; do
  check "info: $text" says "$text"
done
check "info of a blow-up" exits 0 info blown.weftrec
check "says it" says "  blew up at step "
check "info of a killed run" exits 0 info stopped.partial.weftrec
check "says that it is partial" says "partial recording of scene 'hang'"
check "and counts its log" says " with the -wal file beside it"
check "says it on standard error too" one_line "stopped.partial.weftrec: a partial recording, "
check "info of several" exits 2 info a.weftrec gone.weftrec blown.weftrec
check "shows the others" test "$(grep -c "recording of scene" out)" -eq 2
check "info --json" exits 0 info --json a.weftrec blown.weftrec stopped.partial.weftrec
check "one object each" json "[o['file'] for o in r] == ['a.weftrec', 'blown.weftrec', 'stopped.partial.weftrec']"
check "the hash" json "r[0]['content_hash'] == '$hash'"
check "the size" json "r[0]['size_bytes'] == $(stat -c %s a.weftrec)"
check "a partial one with its log" json "r[2]['size_bytes'] == $(($(stat -c %s stopped.partial.weftrec) + $(stat -c %s stopped.partial.weftrec-wal)))"
check "finished or not" json "[o['is_finished'] for o in r] == [True, True, False]"
check "times" json "r[0]['frames'] == 16 and r[0]['first_time_s'] == 0 and abs(r[0]['last_time_s'] - 0.6) < 1e-9"
check "intervals" json "(r[0]['time_step_s'], r[0]['frame_interval_s'], r[0]['duration_s']) == (0.01, 0.04, 0.6)"
check "engine" json "(r[0]['engine'], r[0]['precision']) == ('reference', 'float64')"
check "bodies" json "[b['name'] for b in r[0]['bodies']] == ['cloth', 'ball'] and r[0]['bodies'][0]['faces'] == 4802"
check "blow-up" json "r[0]['blow_up'] is None and r[1]['blow_up']['step'] > 0"
check "info --json of nothing" exits 2 info --json gone.weftrec
check "is an array too" json "r == []"

# diff
check "diff --help" exits 0 diff --help
check "explains its exit codes" says "0 equal in precision, frames and blow-up, bit for bit; 1 different; 2 bad input"
refuses diff a.weftrec
for ((i = 0; i < ${#unreadable[@]}; i += 2)); do
  check "diff a.weftrec ${unreadable[i]}" exits 2 diff a.weftrec "${unreadable[i]}"
  check "names the second file" one_line "weft: ${unreadable[i]}: "
done
check "the same run again" exits 0 run drape_sphere -e reference -j 1 --duration "0.6 s" -o again.weftrec
check "diff of equal ones" exits 0 diff a.weftrec again.weftrec
check "says it" says "a.weftrec and again.weftrec: equal bit for bit, 16 frames"
check "and nothing more" test "$(wc -l <out)" -eq 1
check "a longer run" exits 0 run drape_sphere -e reference --duration "0.64 s" -o longer.weftrec
check "diff of a longer one" exits 1 diff a.weftrec longer.weftrec
for text in "a.weftrec and longer.weftrec: different" "'duration = \"0.6 s\"' and 'duration = \"0.64 s\"'" \
  "  16 and 17 frames, 16 of them at common times" "  the frames at common times are equal bit for bit" "  cloth 'cloth': at the same place"; do
  check "diff: $text" says "$text"
done
check "another integrator" exits 0 run drape_sphere -e reference --integrator runge_kutta_4 --duration "0.6 s" -o other.weftrec
check "diff of another integrator" exits 1 diff a.weftrec other.weftrec -o diff.png
check "says where it begins" grep -qE "^  first difference: frame 1, t = 0.04 s, body 'cloth', position of node [0-9]+$" out
check "says how far" grep -qE "^  cloth 'cloth': at most [0-9.e-]+ m apart, node [0-9]+ at t = 0\.[0-9]+ s; rms [0-9.e-]+ m then, [0-9.e-]+ m over all common times$" out
check "says when the picture is" grep -qE "^diff.png: t = 0\.[0-9]+ s$" out
check "a PNG" test "$(head -c 4 diff.png | tail -c 3)" = "PNG"
check "diff of a blow-up" exits 1 diff a.weftrec blown.weftrec
check "says who blew up" says "  blown.weftrec: blew up at step "
check "and who did not" says "  a.weftrec: no blow-up"
check "diff of another scene" exits 1 diff a.weftrec stopped.partial.weftrec
check "says what has no counterpart" says "  body 'ball': in a.weftrec alone"
check "says what has another mesh" says "  cloth 'cloth': no distance; it has 2500 and 625 nodes"
check "says that one is partial" one_line "stopped.partial.weftrec: a partial recording, "
check "nothing to draw" exits 2 diff a.weftrec stopped.partial.weftrec -o none.png
check "says why" grep -q "weft: none.png: is not drawn, expected recordings with a common time and a common body" err
check "no picture" test ! -e none.png
cp a.weftrec before.weftrec
check "diff spares recordings" exits 2 diff a.weftrec longer.weftrec -o a.weftrec
check "says so before it compares" test ! -s out
check "the recording is whole" cmp a.weftrec before.weftrec

# trim
refuses trim -o part.weftrec
for arguments in "--from 9" "--from \"9 kg\"" "--to 1s" "--every 0" "--every 1.5" "--every 99999999"; do
  check "trim $arguments" eval "exits 2 trim a.weftrec -o part.weftrec $arguments"
  check "names the option" grep -q -- "${arguments%% *}" err
done
check "trim to nothing" exits 2 trim a.weftrec -o part.weftrec --from "0.7 s"
check "says which times there are" one_line "weft: a.weftrec: has no frame from 0.7 s to the end, expected a time from its 16 frames, t = 0 s to 0.6 s"
check "from after to" exits 2 trim a.weftrec -o part.weftrec --from "0.4 s" --to "0.2 s"
check "says so" one_line '--from "0.4 s": is later than --to "0.2 s"'
check "no output" exits 2 trim a.weftrec
check "nothing was written" test -z "$(find . -name 'part*')"
check "trim" exits 0 trim a.weftrec -o part.weftrec --from "0.2 s" --to "0.4 s" --every 2
check "says what is kept" says "part.weftrec: 3 of 16 frames, t = 0.2 s to 0.36 s"
check "no lock and no partial recording is left" test "$(echo part*)" = part.weftrec
check "info of a part" exits 0 info --json part.weftrec
check "it is whole" json "r[0]['is_finished'] and r[0]['frames'] == 3"
check "it says what it is" json "r[0]['provenance']['trimmed'] == 'frames 5 to 9 of 16, counted from 0, one in 2'"
check "diff of a part" exits 1 diff part.weftrec a.weftrec
check "it has the same bits" says "  the frames at common times are equal bit for bit"
check "render of a part" exits 0 render part.weftrec -o part.png --size 96x54
check "export of a part" exits 0 export --html part.html part.weftrec
check "no overwriting" exits 2 trim a.weftrec -o part.weftrec
check "--force" exits 0 trim a.weftrec -o part.weftrec -f
check "of the whole" exits 0 diff part.weftrec a.weftrec
check "into itself" exits 2 trim a.weftrec -o ./a.weftrec -f
check "says so" one_line "-o ./a.weftrec: is the recording to trim, expected another name"
check "the recording is as it was" cmp a.weftrec before.weftrec
check "trim of a killed run" exits 0 trim stopped.partial.weftrec -o saved.weftrec
check "says that it is partial" one_line "stopped.partial.weftrec: a partial recording, "
check "is whole" exits 0 info saved.weftrec
check "says where it comes from" says " of a partial recording, counted from 0"
check "and equal" exits 0 diff stopped.partial.weftrec saved.weftrec
check "trim of a blow-up" exits 0 trim blown.weftrec -o part.weftrec -f
check "keeps the blow-up" exits 0 diff blown.weftrec part.weftrec
(ulimit -f 40; "$weft" trim a.weftrec -o large.weftrec >out 2>err)
check "a part that is too large for the disk" test $? -eq 2
check "says so in one line" one_line "large.partial.weftrec: "
check "leaves nothing" test -z "$(find . -name 'large*')"

# verify
refuses verify
check "verify" exits 0 verify a.weftrec
check "says it" says "a.weftrec: sound"
check "counts frames" says "  all 16 committed frames are readable, 0 to 15 (t = 0 s to 0.6 s)"
check "verify of a killed run" exits 0 verify stopped.partial.weftrec
check "says that it is partial" says "stopped.partial.weftrec: sound, a partial recording whose run has not ended or was stopped"
frames=$(sed -n 's/^  all \([0-9]*\) committed.*/\1/p' out)
check "has every committed frame" grep -qE "^  all [0-9]+ committed frames are readable, 0 to " out
cp stopped.partial.weftrec less.weftrec && head -c 1500000 stopped.partial.weftrec-wal >less.weftrec-wal
check "verify of a log that is cut off" exits 0 verify less.weftrec
fewer=$(sed -n 's/^  all \([0-9]*\) committed frames are readable, 0 to .*/\1/p' out)
check "has what was committed before: ${fewer:=0} of $frames" test "$fewer" -gt 0 -a "$fewer" -le "$frames"
cp a.weftrec damaged.weftrec
python3 - <<'PYTHON'
import sqlite3
database = sqlite3.connect("damaged.weftrec")
database.execute("UPDATE chunk SET data = zeroblob(5) WHERE id = 0")
database.commit()
PYTHON
check "verify of a damaged one" exits 1 verify damaged.weftrec
check "says it" says "damaged.weftrec: damaged"
check "says what is left" grep -qE "^  [0-9]+ of 16 committed frames are readable: [1-9][0-9]* to 15 \(t = " out
check "says what is wrong" says "  damaged.weftrec: data does not have its hash (chunk 0, frames 0 to "
from=$(sed -n 's/^  .* readable: .*(t = \(.* s\) to 0.6 s)$/\1/p' out)
check "the rest can be saved" exits 0 trim damaged.weftrec -o rest.weftrec --from "$from"
check "and is sound" exits 0 verify rest.weftrec
check "verify of several" exits 2 verify a.weftrec gone.weftrec damaged.weftrec
check "looks at all of them" test "$(grep -c "^[a-z]*.weftrec: " out)" -eq 2

finish
