#!/usr/bin/env bash
# Installs what is missing, builds the command and writes a validation report; weft prints where it is.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/tools/step.sh"

case ${1:-} in
  -h | --help)
    cat <<TXT
usage: ./run.sh [--all] [OPTION...]

Installs missing packages (tools/packages.txt), builds the command (preset release), runs the quick validation cases and
writes the report, with pictures, to weft-report/. --all runs every case. 'cmake --build --preset release' builds the rest:
the window, the Python package, the tests. Other options go to 'weft validate'; see
build/release/bin/weft validate --help.
TXT
    exit 0
    ;;
esac

output=(--output "$step_root/weft-report")
tier=(--quick)
before=
for argument in "$@"; do
  case $argument in --output | --output=* | -o*) output=() ;; esac
  # Named cases, the other tier and the list say for themselves what to run.
  case $before,$argument in
    -o,* | --output,* | -e,* | --engine,*) ;;
    *,--all | *,--quick | *,--list | *,--render-only | *,[a-z]*) tier=() ;;
  esac
  before=$argument
done

step "set up" tools/setup.sh build
step "configure" configure release
step "build" build release command

echo "== validate"
"$step_root/build/release/bin/weft" validate "${output[@]}" "${tier[@]}" "$@" || fail "FAILED at: validate (exit status $?)" $?
echo "== summary"
print_step_times
((${#tier[@]} == 0)) || echo "This was the quick tier. Every case, some 30 minutes on two cores: ./run.sh --all"
[[ -x $step_root/build/release/bin/weft-view ]] || echo "The window (weft view), the Python package and the tests: cmake --build --preset release"
