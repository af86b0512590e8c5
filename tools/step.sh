# Sourced by run.sh, test.sh and .ci/run: runs the named steps of a job and says how long each took.

step_root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
step_job=$(basename -- "$0")
step_summary=()

fail() { # message
  printf '%s: %s\n' "$step_job" "$1" >&2
  exit "${2:-1}"
}

# step NAME COMMAND...: runs the command in the source folder; ends the job if it fails.
step() {
  local name=$1 start=$SECONDS status=0
  shift
  printf '== %s\n' "$name"
  set +e # and not '|| status=$?', which would switch -e off inside the command too
  (
    set -e
    cd -- "$step_root"
    "$@"
  )
  status=$?
  set -e
  step_summary+=("$(printf '%6d s  %s' $((SECONDS - start)) "$name")")
  ((status == 0)) || fail "FAILED at: $name (exit status $status)" "$status"
}

print_step_times() {
  printf '%s\n' "${step_summary[@]}"
  printf '%6d s  total\n' "$SECONDS"
}

configure() { # preset [option...]
  cmake --preset "$@" --log-level=WARNING >/dev/null
}

# On a terminal ninja shows one moving line; in a log it stays silent unless something fails.
build() { # preset [target...]
  local preset=$1 quiet=()
  shift
  [[ -t 1 ]] || quiet=(-- --quiet)
  cmake --build --preset "$preset" ${1:+--target "$@"} "${quiet[@]}"
}
