#!/usr/bin/env bash
# What a person sees of the weft command: texts, exit codes, files left behind.
# Usage: command_line_test.sh WEFT SOURCE_DIR with|without (Bullet)
weft=$1
source_dir=$2
bullet=$3
source "$(dirname -- "${BASH_SOURCE[0]}")/command_checks.sh"

# Help and names
check "help" exits 0 --help
check "help names the commands" grep -q "validate" out
check "help explains exit codes" grep -q "Exit codes" out
for command in list run info diff trim verify render check validate; do check "$command --help" exits 0 $command --help; done
check "version" exits 0 --version
check "no command" exits 2
check "unknown command" exits 2 simulate
check "unknown option" exits 2 list --colour
check "unknown scene" exits 2 run drape_spher
check "unknown scene gets a suggestion" grep -q "drape_sphere" err
check "unknown engine" exits 2 run hang --engine physx
check "reference has no float32" exits 2 run hang --precision float32
check "unknown case" exits 2 validate no_such_case -o report
check "bad duration" exits 2 run hang --duration "2 kg"
check "list" exits 0 list --verbose
check "the classic cloth" grep -q "2500 nodes, 28518 springs (24 per interior node)" out

# Malformed scene files: one line with file:line:column, exit 2, nothing left behind
count=0
for file in "$source_dir"/tests/scenes/malformed/*; do
  count=$((count + 1))
  name=$(basename "$file")
  check "check $name" exits 2 check "$file"
  check "$name: one line" test "$(wc -l <err)" -eq 1
  check "$name: names the place" grep -qaE "$name:[0-9]+:[0-9]+: " err
  check "run $name" exits 2 run "$file" -o left.weftrec
  check "$name: nothing left behind" test -z "$(find . -name 'left*')"
done
check "at least 25 malformed files, found $count" test "$count" -ge 25

# Scenes that are allowed and will not work
"$weft" check --resolved "$source_dir/scenes/catalog/hang.toml" | sed 's/^time_step = .*/time_step = "0.05 s"/; s/^frame_interval = .*/frame_interval = "0.05 s"/' >long_step.toml
check "check of a step that is too long" exits 0 check long_step.toml
check "it is warned of" grep -qE "^warning: long_step.toml: cloth 'cloth': the time step 0.05 s is longer than .* \(bullet_forces, .*reference\)$" err
check "a good scene has no warning" exits 0 check "$source_dir/scenes/catalog/hang.toml"
check "and nothing on stderr" test ! -s err

# Mesh files
for file in "$source_dir"/tests/scenes/import/good/*.*; do check "check-mesh $file" exits 0 check-mesh "$file"; done
for file in "$source_dir"/tests/scenes/import/broken/*; do
  check "check-mesh $file" exits 2 check-mesh "$file"
  check "$file: one line" test "$(wc -l <err)" -eq 1
done

# Recordings
short=(run drape_sphere --duration "0.6 s")
check "run" exits 0 "${short[@]}" -o a.weftrec
check "hash is printed" grep -q "content hash" out
grep "content hash" out >hash_a
check "no overwriting" exits 2 "${short[@]}" -o a.weftrec
for threads in 1 2 4; do
  check "run with $threads threads" exits 0 "${short[@]}" -o a.weftrec -f --threads $threads
  grep "content hash" out >hash_b
  check "$threads threads: same hash" cmp -s hash_a hash_b
done
if command -v python3 >/dev/null; then
  check "run with a trace" exits 0 "${short[@]}" -o a.weftrec -f --trace trace.json
  grep "content hash" out >hash_b
  check "a trace changes no bit" cmp -s hash_a hash_b
  check "the trace is sound" "$source_dir/tests/apps/check_trace.py" trace.json tension
  check "the trace can be drawn" "$source_dir/tools/draw_trace.py" trace.json trace.svg
  check "a picture" grep -q "</svg>" trace.svg
fi
check "a trace that cannot be written" exits 2 "${short[@]}" -o t.weftrec --trace /no/such/folder/t.json
check "no recording without it" test ! -e t.weftrec
for trace in t.weftrec ./t.weftrec t.partial.weftrec; do
  check "a trace with a name of the recording" exits 2 "${short[@]}" -o t.weftrec --trace $trace
  check "it says so" grep -q "^weft: --trace $trace: is a name of the recording" err
  check "nothing is left" test -z "$(find . -name 't.*weftrec*' -o -name 't-2.weftrec')"
done
check "another run differs" exits 0 run drape_sphere --duration "0.64 s" -o b.weftrec
grep "content hash" out >hash_b
check "another run: another hash" test "$(cat hash_a)" != "$(cat hash_b)"
cp "$source_dir/scenes/catalog/hang.toml" mine.toml
check "--force spares what is no recording" exits 2 run mine.toml -o mine.toml -f
check "the scene file is whole" cmp -s mine.toml "$source_dir/scenes/catalog/hang.toml"
check "a failed run leaves the old recording" exits 2 run hang --time-step "1 kg" -o a.weftrec -f
check "it is still readable" exits 0 render a.weftrec -o a.png --width 80 --height 50
check "render spares its recording" exits 2 render a.weftrec -o a.weftrec
check "render: --all or --time" exits 2 render a.weftrec -o frames --all --time "1 s"
check "render: several times and styles" exits 0 render a.weftrec -o strip.png --size 96x54 --style shaded,wireframe \
  --times "0 s,0.2 s,0.4 s"
check "it says which frames" grep -q "t = 0 s, 0.2 s, 0.4 s" out
check "render: --size or --width" exits 2 render a.weftrec -o b.png --size 96x54 --width 100
check "render: a size that is none" exits 2 render a.weftrec -o b.png --size 96
check "render: a time without its unit" exits 2 render a.weftrec -o b.png --times 0,1
check "contact sheet" exits 0 contact-sheet a.weftrec b.weftrec -o sheet.png --page pages/scenes.md --width 96
check "a row for each scene" test "$(grep -c "^| !\[drape_sphere\]" pages/scenes.md)" -eq 2
check "a picture for each scene" test -s pages/img/scenes/drape_sphere.png
check "contact sheet of nothing" exits 2 contact-sheet no_such_scene -o sheet.png
check "integrator of the reference only" exits 2 run hang -e bullet_soft --integrator runge_kutta_4 -o x.weftrec
check "reference: a time without its unit" exits 2 reference hang --time 1
check "reference: too few levels" exits 2 reference hang --levels 2
check "reference: no folder for its output" exits 2 reference hang -o /no/such/folder/r.json
check "reference: a gate that is out of reach" exits 1 reference hang --time "0.005 s" --levels 3 --gate 1e-15 -o r.json
check "its order is there all the same" grep -q '"observed_order": [12]' r.json
check "impossible output" exits 2 "${short[@]}" -o /no/such/folder/a.weftrec
for length in 238 247 250; do  # too long with .partial, .lock or .weftrec
  name=$(printf 'a%.0s' $(seq $length))
  check "a name of $length characters" exits 2 "${short[@]}" -o "$name.weftrec"
  check "one line about it" test "$(wc -l <err)" -eq 1
  check "which says why" grep -q "weft: $name.*: File name too long" err
done
check "no file of that name" test -z "$(find . -name 'aaa*')"
for command in "run hang -o" "run hang --trace" "render a.weftrec -o" "contact-sheet a.weftrec -o" "reference hang -o" \
  "contact-table -o" "validate oscillator -o" "stability hang -o" "run hang --duration" "check" "info" "verify" "diff a.weftrec" "diff a.weftrec a.weftrec -o" "trim a.weftrec -o" "trim a.weftrec -o u.weftrec --from"; do
  # shellcheck disable=SC2086
  check "$command ''" exits 2 $command ""
  check "$command '': says so" grep -q "is empty, expected a text" err
done

# The one rule for outputs: nothing of another kind is written over, and no link, folder, device or pipe
echo "my notes" >notes
mkfifo pipe && ln -s notes link && mkdir folder
# A device of its own: root can replace those of the machine, should the rule ever break.
device=/dev/null
[ "$(id -u)" -eq 0 ] && mknod device c 1 3 2>/dev/null && device=device
[ "$(id -u)" -eq 0 ] && [ $device != device ] && device=
for place in notes pipe link folder $device; do
  check "run: $place" exits 2 "${short[@]}" -f -o $place
  check "--trace: $place" exits 2 "${short[@]}" -o u.weftrec --trace $place
  check "render: $place" exits 2 render a.weftrec -o $place --size 96x54
  check "diff: $place" exits 2 diff a.weftrec a.weftrec -o $place
  check "trim: $place" exits 2 trim a.weftrec -f -o $place
  check "contact sheet: $place" exits 2 contact-sheet a.weftrec -o $place
  check "its page: $place" exits 2 contact-sheet a.weftrec -o sheet.png --page $place
  check "reference: $place" exits 2 reference hang --time "0.005 s" --levels 3 -o $place
  check "contact table: $place" exits 2 contact-table -o $place
  check "its CSV: $place" exits 2 contact-table --csv $place
  [ $place = folder ] && echo x >folder/theirs
  check "validate: $place" exits 2 validate oscillator --no-pictures -o $place
  check "stability: $place" exits 2 stability hang -o $place
  check "one line about $place" test "$(wc -l <err)" -eq 1
done
check "all is as it was" test "$(cat notes link)" = "$(printf 'my notes\nmy notes')" -a -p pipe -a -L link -a \( -z "$device" -o -c "$device" \) -a "$(ls -A folder)" = theirs
check "no recording of a refused trace" test ! -e u.weftrec
ln -s nowhere dangling
check "a link to nothing" exits 2 render a.weftrec -o dangling --size 96x54
check "nothing at its end" test ! -e nowhere
check "no lock and no temporary file is left" test -z "$(find . -name '*.lock' -o -name '.weft-*.tmp' -o -name '*partial*')"

# A file that appears during a run, and a trace that cannot be written after it
"$weft" run hang -o late.weftrec --duration "20 s" >out 2>err &
run=$!
while [ ! -e late.partial.weftrec ] && kill -0 $run; do sleep 0.01; done
check "two runs with one output" exits 2 run hang -o late.weftrec --duration "0.1 s" --force
check "says who writes it" grep -q "late.weftrec: is being written by another run (process $run)" err
"$weft" run hang -o late.weftrec --duration "0.1 s" >out 2>&1
check "says so without --force" test $? -eq 2
echo "appeared" >late.weftrec
wait $run
check "a file that appeared: exit code" test $? -eq 2
check "the file is as it was" test "$(cat late.weftrec)" = appeared
check "the recording is beside it" exits 0 info late-2.weftrec
check "whole" grep -q "finished recording of scene 'hang'" out
mkdir traces
"$weft" run hang -o traced.weftrec --duration "4 s" --trace traces/t.json >out 2>err &
run=$!
while [ ! -e traced.partial.weftrec ] && kill -0 $run; do sleep 0.01; done
rmdir traces
wait $run
check "a trace that fails after the run: exit code" test $? -eq 2
check "says that the recording is complete" grep -q "traces/t.json.*the recording is complete in traced.weftrec" err
check "which it is" exits 0 info traced.weftrec

# A partial recording: readers say what it is, and no later command removes it
"$weft" run hang -o stopped.weftrec --duration "1000 s" >out 2>err &
run=$!
while [ ! -s stopped.partial.weftrec-wal ] && kill -0 $run; do sleep 0.01; done
sleep 0.5
kill -TERM $run
wait $run
check "stopped by a signal" test $? -eq 143
check "info opens a partial recording" exits 0 info stopped.partial.weftrec
check "and says so" grep -q "partial recording of scene 'hang'" out
check "render opens it" exits 0 render stopped.partial.weftrec -o stopped.png --size 96x54
check "and says so" grep -q "stopped.partial.weftrec: a partial recording, [0-9]* frames" err
check "the same command again" exits 0 run hang -o stopped.weftrec --duration "0.1 s"
check "says that it is kept" grep -q "stopped.partial.weftrec: left by an earlier run" err
check "it is kept" exits 0 info stopped.partial.weftrec

# Standard output counts
for words in list "list --verbose" --help "check mine.toml" "info a.weftrec" "diff a.weftrec a.weftrec" "verify a.weftrec"; do
  # shellcheck disable=SC2086
  "$weft" $words >/dev/full 2>err
  check "weft $words >/dev/full: exit code" test $? -eq 2
  check "weft $words >/dev/full: message" grep -q "standard output cannot be written" err
  # shellcheck disable=SC2086
  "$weft" $words >&- 2>err
  check "weft $words >&-: exit code" test $? -eq 2
done
check "a closed stream is no output file" exits 0 run hang -o closed.weftrec --duration "0.1 s"
"$weft" run hang -o closed.weftrec -f --duration "0.1 s" >&- 2>&-
check "its recording is sound" exits 0 info closed.weftrec

# No escape sequence reaches the terminal
sed 's/^name = "hang"/name = "evil\\u001b[31m"/; s/^summary = "/&\\u001b]0;title\\u0007/' mine.toml >"$(printf 'evil\033[2J.toml')"
evil=$(printf 'evil\033[2J.toml')
"$weft" check "$evil" >out 2>err
"$weft" check "$evil.missing" >>out 2>>err
"$weft" run "$evil" --duration "0.1 s" -o "$(printf 'evil\033c.weftrec')" >>out 2>>err
"$weft" "$(printf '\033[5m')" >>out 2>>err
"$weft" check-mesh "$(printf 'evil\033[2J.obj')" >>out 2>>err
"$weft" render "$(printf 'evil\033[2J.weftrec')" -o evil.png >>out 2>>err
"$weft" run hang --duration "0.1 s" -o "$(printf 'no\033[2J/evil.weftrec')" >>out 2>>err
check "seven commands that fail" test "$(grep -c "^weft: " err)" -eq 7
check "no escape character" test "$(cat out err | tr -cd '\033\007' | wc -c)" -eq 0
check "it is shown" grep -qF 'evil\x1b[2J.toml' out err

# A machine that is too small
sed 's/nodes = \[[0-9]*, [0-9]*\]/nodes = [1000, 1000]/' mine.toml >large.toml
limit=600000  # kB of address space
if (ulimit -v $limit && "$weft" --version >/dev/null 2>&1); then  # not so under a sanitizer
  (ulimit -v $limit && "$weft" run large.toml -j 1 -o large.weftrec >out 2>err)
  check "no memory: exit code" test $? -eq 2
  check "no memory: says so" grep -q "^weft: there is not enough memory" err
  check "nothing left" test ! -e large.weftrec -a ! -e large.partial.weftrec
fi

# Blow-up as data
check "explicit Euler" exits 1 run drape_sphere --integrator explicit_euler -o c.weftrec
check "step, time and node" grep -qE "blew up at step [0-9]+, t = .* node [0-9]+" out

check "the guard's stable step" grep -q ": too large, modes of the springs grow" out
check "reference says what is stable" exits 0 "${short[@]}" -o c.weftrec -f
check "stable step of the classic" grep -qE "time step 0.01 s, stable up to 0.01[0-9]* s$" out

# Far beyond the stable step no engine crashes: it blows up as data, or it survives
sed 's|"0.5 N/m"|"5000 N/m"|; s|duration = "6 s"|duration = "0.6 s"|' "$source_dir/scenes/catalog/drape_sphere.toml" >stiff.toml
engines="reference:float64"
[ "$bullet" = with ] && engines="$engines bullet_forces:float32 bullet_forces:float64 bullet_soft:float32 bullet_soft:float64"
[ "$bullet" = with ] && engines="$engines bullet_deformable:float32 bullet_deformable:float64 bullet_deformable_implicit:float32"
for engine in $engines; do
  "$weft" run stiff.toml -e "${engine%:*}" -p "${engine#*:}" -o stiff.weftrec -f >out 2>err
  code=$?
  check "stiff cloth in $engine: exit $code" test "$code" -le 1
  [ "$code" -eq 1 ] && check "stiff cloth in $engine: reported" grep -q "blew up at step" out
done

# Pictures
check "render" exits 0 render a.weftrec -o a.png --width 160 --height 100
check "a PNG" test "$(head -c 4 a.png | tail -c 3)" = "PNG"
check "render a text file" exits 2 render hash_a -o b.png
check "nothing left of it" test ! -e b.png
check "render of nothing" exits 2 render no_such.weftrec -o b.png

# Engines of both precisions from one command
if [ "$bullet" = with ]; then
  for engine in bullet_soft bullet_forces bullet_deformable bullet_deformable_implicit; do
    for precision in float32 float64; do
      check "$engine $precision" exits 0 "${short[@]}" -e $engine -p $precision -o $engine-$precision.weftrec
      grep "content hash" out >hash_a
      check "$engine $precision again" exits 0 "${short[@]}" -e $engine -p $precision -o again.weftrec -f --threads 2
      grep "content hash" out >hash_b
      check "$engine $precision: same hash in another process" cmp -s hash_a hash_b
    done
  done
else
  check "no Bullet: says so" exits 2 "${short[@]}" -e bullet_soft -o d.weftrec
fi

# A program that is only another name of this one does not start itself for ever
mkdir alias && cp "$weft" alias/weft && cp "$weft" alias/weft-float64
check "weft-float64 as a copy" timeout 20 sh -c 'alias/weft run hang -e bullet_soft -p float64 -o alias.weftrec 2>err; test $? -eq 2'
rm alias/weft-float64 && ln -s weft alias/weft-float64
check "weft-float64 as a link" timeout 20 sh -c 'alias/weft run hang -e bullet_soft -p float64 -o alias.weftrec 2>err; test $? -eq 2'
check "one line" test "$(wc -l <err)" -eq 1
rm -r alias

# A report
check "validate" exits 0 validate oscillator hanging_chain -o report --no-pictures
check "progress for a pipe, a line for each case" test "$(grep -cE '^case [12] of 2: [a-z_]+ \([0-9.]+ s\)$' err)" -eq 2
for file in index.html report.json junit.xml; do check "$file" test -s report/$file; done
check "one point of a case" exits 0 validate cantilever --gamma 3.7 --nodes 60 --angle 17 --engine reference -o report --no-pictures
check "one point: says where" grep -q "N = 60, grid at 16.7 degrees" out
cp report/index.html first.html && echo "an older page" >report/index.html
check "the page again" exits 0 validate --render-only -o report
check "which is the same" cmp report/index.html first.html
check "the page of no report" exits 2 validate --render-only -o none
check "says what is missing" grep -q "none/report.json" err
check "render only and a case" exits 2 validate catenary --render-only -o report
check "a value out of range" exits 2 validate cantilever --gamma 900 -o none
check "a value out of range: says what is expected" grep -q "gamma = 900 \[1\], expected 0.05 to 500" err
check "a parameter of another case" exits 2 validate catenary --gamma 1 -o none
check "a parameter without a case" exits 2 validate --gamma 1 -o none
check "no report from bad input" test ! -e none
check "quick and a case" exits 2 validate catenary --quick -o none
check "list of the cases" exits 0 validate --list
check "list: parameters with unit and range" grep -q -- "--gamma \[1\].*0.05 to 500" out

finish
