#!/usr/bin/env bash
# Runs every target of the preset fuzz, one after the other.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

case ${1:-} in
  '' | -h | --help)
    echo "usage: fuzz/run.sh SECONDS [TARGET...]   (after: cmake --preset fuzz && cmake --build --preset fuzz)"
    exit 0
    ;;
esac
seconds=$1
shift
targets=("$@")
((${#targets[@]})) || mapfile -t targets < <(find fuzz/corpus -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)

mkdir -p build/fuzz/faults
status=0
for target in "${targets[@]}"; do
  echo "== fuzz $target, $seconds s"
  mkdir -p "build/fuzz/corpus/$target"
  # A leak in a child that ends at once is none.
  ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 nice "build/fuzz/fuzz/fuzz_$target" \
    -max_total_time="$seconds" -timeout=20 -rss_limit_mb=3000 -max_len=20000 -print_final_stats=1 -verbosity=0 \
    -artifact_prefix="build/fuzz/faults/$target-" "build/fuzz/corpus/$target" "fuzz/corpus/$target" 2>"build/fuzz/$target.log" || status=1
  grep -E 'stat::number_of_executed_units|ERROR|SUMMARY|broken promise|Test unit written' "build/fuzz/$target.log" || true
done
exit "$status"
