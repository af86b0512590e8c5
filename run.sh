#!/usr/bin/env bash
# Installs what is missing, builds Weft and writes the validation report; weft prints where it is.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/tools/step.sh"

case ${1:-} in
  -h | --help)
    cat <<TXT
usage: ./run.sh [OPTION...]

Installs missing packages (tools/packages.txt), builds the release preset, runs every validation case and writes the
report to weft-report/. Options go to 'weft validate'; see build/release/bin/weft validate --help.
TXT
    exit 0
    ;;
esac

output=(--output "$step_root/weft-report")
for argument in "$@"; do
  case $argument in --output | --output=* | -o*) output=() ;; esac
done

step "set up" tools/setup.sh build
step "configure" configure release
step "build" build release apps/all

echo "== validate"
"$step_root/build/release/bin/weft" validate "${output[@]}" "$@" || fail "FAILED at: validate (exit status $?)" $?
