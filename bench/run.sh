#!/usr/bin/env bash
# Installs what is missing, builds the benchmarks and writes bench/results/*.csv.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../tools/step.sh"

case ${1:-} in
  -h | --help)
    cat <<TXT
usage: bench/run.sh [NAME...] [OPTION...]
       bench/run.sh peers [--nvcloth FOLDER] [--jolt FOLDER] [WORKLOAD...] [OPTION...]

Installs missing packages (tools/packages.txt), builds the release preset with benchmarks and runs them. Names and options go
to weft-bench; see build/release/bin/weft-bench --help.

peers measures Weft beside the cloth of NvCloth 1.1.6 and Jolt Physics 5, whose sources are in these folders (nothing is fetched),
and writes bench/results/peers.csv; the rest goes to weft-bench-peers.
TXT
    exit 0
    ;;
esac

if [[ ${1:-} == peers ]]; then
  shift
  nvcloth='' jolt='' rest=()
  while (($#)); do
    case $1 in
      --nvcloth | --jolt)
        [[ -d ${2:-} ]] || { echo "bench/run.sh: $1 '${2:-}', expected the folder of its sources" >&2; exit 2; }
        printf -v "${1#--}" %s "$(realpath -- "$2")"
        shift 2
        ;;
      *)
        rest+=("$1")
        shift
        ;;
    esac
  done
  [[ $nvcloth || $jolt ]] || { echo "bench/run.sh: peers without --nvcloth and --jolt, expected the folder of one's sources" >&2; exit 2; }
  step "set up" tools/setup.sh build
  step "configure" configure release -DWEFT_BUILD_BENCH=ON "-DWEFT_NVCLOTH_DIR=$nvcloth" "-DWEFT_JOLT_DIR=$jolt"
  step "build" build release weft-bench-peers
  exec "$step_root/build/release/bin/weft-bench-peers" "${rest[@]}"
fi

step "set up" tools/setup.sh build
step "configure" configure release -DWEFT_BUILD_BENCH=ON
step "build" build release weft-bench weft-bench-float64

echo "== bench"
"$step_root/build/release/bin/weft-bench" "$@" || fail "FAILED at: bench (exit status $?)" $?
(($#)) || "$step_root/build/release/bin/weft-bench-float64" bullet
