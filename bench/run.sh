#!/usr/bin/env bash
# Installs what is missing, builds the benchmarks and writes bench/results/*.csv.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../tools/step.sh"

case ${1:-} in
  -h | --help)
    cat <<TXT
usage: bench/run.sh [NAME...] [OPTION...]

Installs missing packages (tools/packages.txt), builds the release preset with benchmarks and runs them. Names and options go
to weft-bench; see build/release/bin/weft-bench --help.
TXT
    exit 0
    ;;
esac

step "set up" tools/setup.sh build
step "configure" configure release -DWEFT_BUILD_BENCH=ON
step "build" build release weft-bench weft-bench-float64

echo "== bench"
"$step_root/build/release/bin/weft-bench" "$@" || fail "FAILED at: bench (exit status $?)" $?
(($#)) || "$step_root/build/release/bin/weft-bench-float64" bullet
