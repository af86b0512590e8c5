#!/usr/bin/env bash
# What a person sees of the weft command: texts, exit codes, files left behind.
# Usage: command_line_test.sh WEFT SOURCE_DIR with|without (Bullet)
set -u
weft=$1
source_dir=$2
bullet=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
checks=0

check() {  # check DESCRIPTION COMMAND...: the command must succeed
  checks=$((checks + 1))
  if ! "${@:2}"; then
    echo "FAILED: $1"
    failures=$((failures + 1))
  fi
}

exits() {  # exits CODE ARGUMENTS...: weft must end with this code; output in out and err
  local expected=$1
  "$weft" "${@:2}" >out 2>err
  local code=$?
  [ "$code" -eq "$expected" ] || { echo "weft ${*:2}: exit $code, expected $expected"; cat err; return 1; }
}

# Help and names
check "help" exits 0 --help
check "help names the commands" grep -q "validate" out
check "help explains exit codes" grep -q "Exit codes" out
for command in list run render check validate; do check "$command --help" exits 0 $command --help; done
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

# A report
check "validate" exits 0 validate oscillator hanging_chain -o report --no-pictures
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

echo "$((checks - failures)) passed, $failures failed"
[ "$failures" -eq 0 ]
