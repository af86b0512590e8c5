# Sourced by tests of commands, with the command in $weft: an empty folder to work in, checks that are counted, and a last line.
set -u
weft=$(realpath "$weft") || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
checks=0
timeout=$(command -v timeout) # a test may take PATH away
time_limit=600                # [s] of a command

check() { # check DESCRIPTION COMMAND...: the command must succeed
  checks=$((checks + 1))
  if ! "${@:2}"; then
    echo "FAILED: $1"
    failures=$((failures + 1))
  fi
}

exits() { # exits CODE ARGUMENTS...: weft must end with this code; output in out and err
  local expected=$1
  "$timeout" "$time_limit" "$weft" "${@:2}" >out 2>err
  local code=$?
  [ "$code" -eq "$expected" ] || { echo "weft ${*:2}: exit $code, expected $expected"; cat err; return 1; }
}

finish() {
  echo "$checks checks, $failures failed"
  [ "$failures" -eq 0 ]
}
