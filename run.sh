#!/usr/bin/env bash
# Installs what is missing, builds Weft and writes the validation report.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/tools/step.sh"

case ${1:-} in
  -h | --help)
    cat <<TXT
usage: ./run.sh [OPTION...]

Installs missing packages (tools/packages.txt), builds the release preset, runs every validation case and writes the
report to weft-report/. Options go to 'weft validate'; see build/release/apps/weft validate --help.
TXT
    exit 0
    ;;
esac

output=$step_root/weft-report
options=(--output "$output")
arguments=("$@")
for ((i = 0; i < $#; ++i)); do
  case ${arguments[i]} in
    --output) output=${arguments[i + 1]:-} options=() ;;
    --output=*) output=${arguments[i]#--output=} options=() ;;
  esac
done

step "set up" tools/setup.sh build
step "configure" configure release
step "build" build release apps/all

echo "== validate"
status=0
"$step_root/build/release/apps/weft" validate "${options[@]}" "$@" || status=$?
[[ -e $output/index.html ]] && echo "Report: $output/index.html"
((status == 0)) || fail "FAILED at: validate (exit status $status)" "$status"
