#!/usr/bin/env bash
# Runs catalog scenes for much longer than they are made for, and keeps what came of it: bench/results/long_runs.csv.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/step.sh"
step_job=tools/long_runs.sh

if (($# < 2)) || [[ $1 == --help || $1 == -h ]]; then
  cat <<TXT
usage: tools/long_runs.sh BUILD SECONDS [SCENE...]

Simulates SECONDS of each SCENE (default: all of the catalog) with the test long_run_test of the build folder BUILD,
which fails for an explosion, a value that is not finite, or memory that grows; one row each in
bench/results/long_runs.csv, in place of the scene's row for the same kind of build and time. A scene of
drop_ground's size takes about as long as it says, tear, stack and colliders five to ten times as long; under sanitizers ten
times that. Scenes with a row from this commit are left out, so that a run that was stopped goes on.
TXT
  exit $(($# < 2 ? 2 : 0))
fi
build=$1 seconds=$2
shift 2
test=$step_root/$build/tests/catalog/long_run_test
[[ -x $test ]] || fail "there is no $build/tests/catalog/long_run_test; build the target long_run_test first"
[[ $seconds =~ ^[1-9][0-9]*$ ]] || fail "SECONDS is '$seconds', expected a whole number above 0"
scenes=("$@")
if ((${#scenes[@]} == 0)); then
  mapfile -t scenes < <("$test" --gtest_list_tests | sed -n 's|^  [A-Za-z]*/\([a-z_]*\).*|\1|p')
fi
kind=release
grep -q '^CMAKE_CXX_FLAGS:STRING=.*-fsanitize=address' "$step_root/$build/CMakeCache.txt" && kind=sanitizers
commit=$(git -C "$step_root" rev-parse --short HEAD)
table=$step_root/bench/results/long_runs.csv
export LSAN_OPTIONS=suppressions=$step_root/tools/lsan.supp WEFT_LONG_RUN_SECONDS=$seconds

[[ -e $table ]] || echo "scene,engine,build,simulated_s,live_mib_at_a_fifth,live_mib_at_end,commit" >"$table"
for scene in "${scenes[@]}"; do
  grep -qE "^$scene,[a-z_]*,$kind,$seconds,.*,$commit\$" "$table" && continue
  output=$("$test" --gtest_filter="*/$scene") || { echo "$output"; fail "FAILED: $scene"; }
  # 'hang   bullet_forces   600 s simulated in   366.4 s,   6.71 MiB live at a fifth,   6.71 at the end'
  row=$(awk -v kind="$kind" -v seconds="$seconds" -v commit="$commit" \
    '/ s simulated in /{print $1 "," $2 "," kind "," seconds "," $9 "," $15 "," commit}' <<<"$output")
  [[ -n $row ]] || fail "there is no scene '$scene' in the catalog"
  (
    flock 9 # two of these may run at once
    { grep -vE "^$scene,[a-z_]*,$kind,$seconds," "$table"; echo "$row"; } >"$table.part"
    mv "$table.part" "$table"
  ) 9>"$step_root/build/long_runs.lock"
  echo "$row"
done
