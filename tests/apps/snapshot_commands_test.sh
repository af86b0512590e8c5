#!/usr/bin/env bash
# A run that another process goes on with has the bits of the run that was saved: weft run --snapshot, --resume.
# Usage: snapshot_commands_test.sh WEFT with|without
set -euo pipefail
weft=$1
bullet=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# scene engine precision middle end: times of frames
goes_on() {
  local scene=$1 engine=$2 precision=$3 middle=$4 end=$5 name="$1-$2-$3"
  "$weft" run "$scene" -e "$engine" -p "$precision" --duration "$end" --snapshot-at "$middle" -o "$name.weftrec" > log 2>&1 \
    || fail "$name: $(tail -1 log)"
  "$weft" run "$scene" --duration "$end" --resume "$name.weftsnap" -o "$name-later.weftrec" > log 2>&1 \
    || fail "$name resumed: $(tail -1 log)"
  "$weft" diff "$name.weftrec" "$name-later.weftrec" > diff.log 2>&1 || true
  grep -q "equal bit for bit" diff.log || fail "$name: $(cat diff.log)"
}

# cmd expected-text: refused with one line that says so
refuses() {
  local expected=$1
  shift
  if "$weft" "$@" > log 2>&1; then fail "weft $* was not refused"; fi
  grep -q "$expected" log || fail "weft $*: $(cat log), expected '$expected'"
}

goes_on hang reference float64 "0.2 s" "0.4 s"
if [ "$bullet" = with ]; then
  for precision in float32 float64; do
    goes_on hang bullet_forces "$precision" "0.2 s" "0.4 s"
    goes_on drape_sphere bullet_weft "$precision" "0.8 s" "1.2 s"
    goes_on drape_sphere bullet_soft "$precision" "0.8 s" "1.2 s"
    goes_on ball_on_cloth bullet_weft "$precision" "0.6 s" "0.7 s"
    goes_on caped_figure bullet_weft "$precision" "0.4 s" "0.6 s"
    goes_on tear bullet_weft "$precision" "0.6 s" "0.8 s"
    goes_on stack bullet_weft "$precision" "0.4 s" "0.6 s"
    goes_on drape_sphere bullet_deformable "$precision" "0.8 s" "1.2 s"
    goes_on drape_sphere bullet_deformable_implicit "$precision" "0.8 s" "1.2 s"
  done
fi

"$weft" run hang -e reference --duration "0.2 s" --snapshot end.weftsnap -o end.weftrec > log 2>&1
grep -q "end.weftsnap: state after step" log || fail "no word of the snapshot: $(cat log)"
refuses "is of another scene" run drop_box -e reference --resume end.weftsnap -o other.weftrec
refuses "expected a run that lasts longer" run hang -e reference --duration "0.2 s" --resume end.weftsnap -o other.weftrec
refuses "end.weftsnap: snapshot: is of another scene" run hang -e reference --time-step "1/5000 s" --resume end.weftsnap -o other.weftrec
refuses "is no snapshot" run hang --resume end.weftrec -o other.weftrec
refuses "expected a time after" run hang -e reference --duration "0.2 s" --snapshot-at "3 s" -o other.weftrec
head -c 2000 end.weftsnap > cut.weftsnap
refuses "does not have its hash" run hang --resume cut.weftsnap -o other.weftrec
if [ "$bullet" = with ]; then
  refuses "is of reference in float64, expected one of bullet_weft" run hang -e bullet_weft --resume end.weftsnap -o other.weftrec
fi
[ ! -e other.weftsnap ] && [ ! -e other.weftrec ] || fail "a refused run has left a file"
echo passed
