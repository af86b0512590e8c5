#!/usr/bin/env bash
# What a person sees of weft export: texts, exit codes, files left behind.
# Usage: export_command_test.sh WEFT
weft=$1
source "$(dirname -- "${BASH_SOURCE[0]}")/../../apps/command_checks.sh"

one_line() { [ "$(wc -l <err)" -eq 1 ] && grep -q "$1" err; }
no_page() { [ -z "$(find . -name '*.html' -newer stamp)" ]; }

check "run" exits 0 run hang --engine reference --duration "0.1 s" -o hang.weftrec
touch stamp

# Bad input: one line, exit code 2, no page
check "nothing to do" exits 2 export
check "nothing to do: says what was expected" one_line "expected --html OUT.html RECORDING"
check "no recording" exits 2 export --html page.html
check "no recording: says so" one_line "without a recording"
check "recordings without a page" exits 2 export hang.weftrec
check "missing file" exits 2 export --html page.html gone.weftrec
check "missing file: names it" one_line "gone.weftrec: "
echo "a text" >text.weftrec
check "no recording at all" exits 2 export --html page.html hang.weftrec text.weftrec
check "no recording at all: names it" one_line "text.weftrec: not a Weft recording"
head -c 20000 hang.weftrec >cut.weftrec
check "cut off" exits 2 export --html page.html cut.weftrec
check "cut off: names it" one_line "cut.weftrec: "
for error in "1 kg" "0 mm" "-1 mm" "nan m" "1 pm" "1 km"; do
  check "error $error" exits 2 export --html page.html --error="$error" hang.weftrec
  check "error $error: names it" one_line "error"
done
check "folder that is not there" exits 2 export --html gone/page.html hang.weftrec
check "a folder" exits 2 export --html . hang.weftrec
check "nothing was written" no_page

# Other people's files
echo "<!doctype html><p>mine</p>" >mine.html
cp mine.html before.html
check "another page" exits 2 export --html mine.html hang.weftrec
check "another page: says why" one_line "is not a playback page made by Weft"
check "another page stays" cmp -s mine.html before.html
ln -s mine.html link.html
check "a symbolic link" exits 2 export --html link.html hang.weftrec
check "what it leads to stays" cmp -s mine.html before.html

# What is right
check "export" exits 0 export --html page.html hang.weftrec
check "says the rounding" grep -q "positions rounded by at most 0.01 mm" out
check "says the size" grep -q "page.html: [0-9.]* MB" out
check "again, over its own page" exits 0 export --html page.html --error "0.1 mm" hang.weftrec
check "the rounding that was asked for" grep -q "at most 0.1 mm" out
check "two recordings" exits 0 export --html both.html hang.weftrec hang.weftrec
check "the player" exits 0 export --player player.html
check "the player has no recording" test "$(wc -c <player.html)" -lt "$(wc -c <page.html)"
check "over a page" exits 0 export --player page.html

# Files for other programs
check "pc2" exits 0 export --pc2 caches hang.weftrec
check "pc2: says spacing and rounding" grep -q "s apart; positions rounded by at most" out
check "pc2: writes a cache and its mesh" test -s caches/cloth.pc2 -a -s caches/cloth.obj
check "pc2: its own folder again" exits 0 export --pc2 caches hang.weftrec
check "vtp" exits 0 export --vtp series hang.weftrec
check "vtp: writes the times" test -s series/series.pvd
mkdir other && echo mine >other/cloth.pc2
check "pc2: another folder" exits 2 export --pc2 other hang.weftrec
check "pc2: another folder stays" test "$(cat other/cloth.pc2)" = mine
check "pc2: two recordings" exits 2 export --pc2 two hang.weftrec hang.weftrec
check "pc2: two recordings: says so" one_line "2 recordings with --gltf, --pc2 or --vtp, expected one"
check "pc2 with a page" exits 2 export --pc2 two --html two.html hang.weftrec
check "gltf" exits 0 export --gltf hang.glb hang.weftrec
check "gltf: says how near it is" grep -Eq "morph targets; nodes at most [0-9.e-]+ mm from the recording, rms" out
check "gltf: no warning" test ! -s err
check "gltf: over its own file" exits 0 export --gltf hang.glb --gltf-error "0.1 mm" hang.weftrec
check "gltf: an error that single precision cannot reach" exits 0 export --gltf fine.glb --gltf-error "0.001 um" hang.weftrec
check "gltf: warns of it" one_line "warning: fine.glb: cloth 'cloth' is up to .* mm from the recording with .* morph targets, expected at most 1e-06 mm"
check "gltf: writes it all the same" grep -q '"is_within_error":false' fine.glb
printf 'glTF of somebody else' >other.glb
check "gltf: another file" exits 2 export --gltf other.glb hang.weftrec
check "gltf: another file: says why" one_line "is not a glTF file made by Weft"
check "gltf: another file stays" test "$(cat other.glb)" = "glTF of somebody else"
for error in "1 kg" "0 mm" "-1 mm" "nan m" "1"; do
  check "gltf: error $error" exits 2 export --gltf bad.glb --gltf-error="$error" hang.weftrec
  check "gltf: error $error: names it" one_line "gltf-error"
done
check "gltf: error without a file" exits 2 export --pc2 two --gltf-error "1 mm" hang.weftrec
check "gltf: error without a file: says so" one_line "gltf-error without --gltf"
check "gltf with a page" exits 2 export --gltf bad.glb --html two.html hang.weftrec
check "gltf: nothing is written after bad input" test ! -e bad.glb
"$weft" run tear --duration "1 s" -o tear.weftrec >out 2>err  # not in a build without Bullet
if [ -s tear.weftrec ]; then
  check "pc2: a torn cloth" exits 2 export --pc2 torn tear.weftrec
  check "pc2: a torn cloth: says when" one_line "tear.weftrec: cloth '.*' is torn at t = "
  check "pc2: a torn cloth: writes nothing" test ! -e torn/sheet.pc2
  check "vtp: a torn cloth" exits 0 export --vtp torn_series tear.weftrec
fi

finish
