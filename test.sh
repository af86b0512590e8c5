#!/usr/bin/env bash
# Installs what is missing, builds Weft in the folder that run.sh uses, and runs the tests.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/tools/step.sh"

preset=release
precisions=()
selection=(--label-exclude '^slow$')
while (($#)); do
  case $1 in
    -h | --help)
      cat <<TXT
usage: ./test.sh [--all] [--preset NAME]

Installs missing packages (tools/packages.txt), builds a preset of CMakePresets.json (default: release, as
./run.sh does; ci has warnings as errors) and runs its tests: in single precision, and with ci in both. --all runs
both with any preset, and the tests with the label slow too.
TXT
      exit 0
      ;;
    --all) selection=() precisions=(-D WEFT_TEST_BOTH_PRECISIONS=ON) ;;
    --preset) preset=${2:?test.sh: --preset needs a name}; shift ;;
    *) fail "unknown option '$1', see ./test.sh --help" 2 ;;
  esac
  shift
done

step "set up" tools/setup.sh build test
step "configure" configure "$preset" "${precisions[@]}"
step "build" build "$preset"
step "test" ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j "$(nproc)" "${selection[@]}"
