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

# On a terminal ninja shows one moving line; in a log a line for each tenth of the build, and what fails.
build() { # preset [target...]
  local preset=$1
  shift
  if [[ -t 1 ]]; then
    cmake --build --preset "$preset" ${1:+--target "$@"}
  else
    NINJA_STATUS='[%f %t %e] ' cmake --build --preset "$preset" ${1:+--target "$@"} | show_tenths
  fi
}

# Of ninja's lines '[done total seconds] ...' one for each tenth; all that is no such line.
show_tenths() {
  awk '/^\[[0-9]+ [0-9]+ [0-9.]+\] / {
         tenth = int(10 * substr($1, 2) / $2)
         if (tenth > last) { printf "build: %d of %d (%d s)\n", substr($1, 2), $2, $3; fflush() }
         last = tenth
         next
       }
       { print; fflush() }'
}
