#!/usr/bin/env bash
# Installs the packages of tools/packages.txt that are missing. With nothing missing it needs no root and no network.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)

usage() {
  cat <<TXT
usage: tools/setup.sh [--list] [GROUP...]

Installs what is missing of the groups (build test lint browser windows, default: build test) of tools/packages.txt,
as root or through sudo. --list prints the missing packages and installs nothing.
Exit status: 0 everything is there, 1 the installation failed, 2 it cannot be installed from here.
TXT
}

list_only=no
groups=()
for argument in "$@"; do
  case $argument in
    -h | --help) usage; exit 0 ;;
    --list) list_only=yes ;;
    build | test | lint | browser | windows) groups+=("$argument") ;;
    *) echo "setup: unknown argument '$argument', expected --list or one of: build test lint browser windows" >&2; exit 2 ;;
  esac
done
((${#groups[@]})) || groups=(build test)

is_debian=no
command -v dpkg-query >/dev/null && command -v apt-get >/dev/null && is_debian=yes

is_installed() { # package [command]
  [[ -n $2 ]] && command -v "$2" >/dev/null && return
  [[ $is_debian == yes && $(dpkg-query -W -f '${db:Status-Abbrev}' "$1" 2>/dev/null) == ?i* ]]
}

missing=()          # packages
missing_commands=() # those of them that are commands: all that can be checked off Debian
group=
while read -r package command _; do
  case $package in
    '' | '#'*) continue ;;
    '['*']') group=${package//[\[\]]/}; continue ;;
  esac
  [[ " ${groups[*]} " == *" $group "* ]] || continue
  [[ $command == '#'* ]] && command=
  is_installed "$package" "$command" && continue
  missing+=("$package")
  [[ -n $command ]] && missing_commands+=("$command")
done <"$here/packages.txt"

if [[ $list_only == yes ]]; then
  ((${#missing[@]} == 0)) || printf '%s\n' "${missing[@]}"
  exit 0
fi
((${#missing[@]})) || exit 0

if [[ $is_debian == no ]]; then
  echo "setup: not a Debian or Ubuntu system; Weft needs the equivalents of: ${missing[*]}" >&2
  if ((${#missing_commands[@]})); then
    echo "setup: not found: ${missing_commands[*]}" >&2
    exit 2
  fi
  echo "setup: the tools are there, going on; CMake names any library it does not find" >&2
  exit 0
fi

as_root=()
if [[ $(id -u) != 0 ]]; then
  # sudo may ask for a password only where somebody can answer.
  if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
    as_root=(sudo)
  else
    echo "setup: missing packages, and neither root nor sudo to install them; run as root:" \
      "apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 2
  fi
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q -o Acquire::Retries=3 "$@" >>"$log" 2>&1 </dev/null; }
install_missing() { apt install --no-install-recommends "${missing[@]}"; }

echo "setup: installing ${#missing[@]} packages: ${missing[*]}"
# The package lists are fetched only if they turn out to be absent or too old.
if ! install_missing && ! { apt update && install_missing; }; then
  tail -n 15 "$log" >&2
  echo "setup: apt-get could not install: ${missing[*]}" >&2
  exit 1
fi
