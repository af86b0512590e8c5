#!/usr/bin/env bash
# Compiles Weft's libraries for Windows, runs a program with them under Wine and compares its state with that of the same program here.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/step.sh"
step_job=tools/windows.sh

usage() {
  cat <<TXT
usage: tools/windows.sh [--folder FOLDER] [--native PREFIX] [--jobs N] [--if-installed]

On Debian: installs what is missing (groups build and windows of tools/packages.txt), gets the source of Debian's Bullet, compiles it and
Weft's libraries for Windows with MinGW, in both precisions, and compiles Weft for this machine. Then Wine runs the tests of files and threads,
and the program of tests/install/bits in both precisions, whose state after a third of a second must be that of the same program on this
machine, bit for bit.

--folder FOLDER   for all that is made (default: build/windows). It has the libraries and the headers for Windows in FOLDER/prefix.
--native PREFIX   compare with the Weft that is installed there, which must be of this source, compiler and build type Release.
--jobs N          processes that compile at a time (default: one for each processor)
--if-installed    install nothing, and end with 77 if a package is missing
TXT
}

folder=$step_root/build/windows
native=
jobs=$(nproc)
if_installed=no
while (($#)); do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --folder) folder=$(realpath -m -- "${2:?windows.sh: --folder needs a path}"); shift ;;
    --native) native=$(realpath -- "${2:?windows.sh: --native needs a path}"); shift ;;
    --jobs) jobs=${2:?windows.sh: --jobs needs a number}; shift ;;
    --if-installed) if_installed=yes ;;
    *) fail "unknown option '$1', see tools/windows.sh --help" 2 ;;
  esac
  shift
done
[[ $jobs =~ ^[1-9][0-9]*$ ]] || fail "--jobs is '$jobs', expected a whole number above 0" 2

toolchain=$step_root/cmake/toolchains/mingw_w64.cmake
for_windows=(-G Ninja "-DCMAKE_TOOLCHAIN_FILE=$toolchain" "-DCMAKE_PREFIX_PATH=$folder/prefix" -DEigen3_DIR=/usr/share/eigen3/cmake
  -DCMAKE_BUILD_TYPE=Release)
for_this_machine=(-G Ninja -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Release)
wine=$(command -v wine64 || true)
wine=${wine:-/usr/lib/wine/wine64}
# A Windows of its own, so that nothing depends on what is in the user's.
export WINEPREFIX=$folder/wine WINEDEBUG=-all WINEDLLOVERRIDES=mscoree,mshtml=

# With --if-installed a test that is skipped, else a mistake.
not_here() { # reason
  [[ $if_installed == no ]] || fail "skipped, for $1" 77
  fail "$1" 2
}

# Shows what a command prints only if it fails.
quietly() { # command...
  local log=$folder/log.txt
  "$@" >"$log" 2>&1 || { tail -n 40 "$log" >&2; return 1; }
}

# The list of sources is one of our own, with the server from which this machine has its packages: neither the system's is changed nor are its rights needed. apt checks what it gets.
get_bullet() {
  local version release server lists=$folder/apt
  version=$(dpkg-query -W -f '${Version}' libbullet-dev)
  [[ -e $folder/bullet_source/.version && $(<"$folder/bullet_source/.version") == "$version" ]] && return
  release=$(. /etc/os-release && echo "$VERSION_CODENAME")
  server=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' | awk -v release="$release" '$2 == release { print $1; exit }')
  [[ -n $server ]] || fail "no source of packages of Debian $release is known to apt, expected one in /etc/apt" 2
  mkdir -p "$lists/lists/partial" "$lists/archives/partial"
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $server $release main" >"$lists/sources.list"
  local apt=(apt-get -q -o "Dir::Etc::SourceList=$lists/sources.list" -o Dir::Etc::SourceParts=/dev/null -o "Dir::State::Lists=$lists/lists"
    -o "Dir::Cache=$lists" -o APT::Sandbox::User=root -o Acquire::Retries=3)
  cd -- "$lists"
  quietly "${apt[@]}" update
  quietly "${apt[@]}" source --download-only "bullet=$version"
  rm -rf -- "$folder/bullet_source"
  quietly dpkg-source --no-copy -x "bullet_${version#*:}.dsc" "$folder/bullet_source"
  echo "$version" >"$folder/bullet_source/.version"
}

# As Debian compiles it, whose flags are those of RelWithDebInfo, but for shared libraries and what helps debuggers.
build_bullet() {
  local precision
  for precision in OFF ON; do
    local build=$folder/bullet_double_$precision
    quietly cmake -S "$folder/bullet_source" -B "$build" "${for_windows[@]}" "-DCMAKE_INSTALL_PREFIX=$folder/prefix" "-DCMAKE_CXX_FLAGS=-w" \
      "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG" "-DUSE_DOUBLE_PRECISION=$precision" -DBUILD_SHARED_LIBS=OFF -DBUILD_EXTRAS=OFF \
      -DBUILD_BULLET2_DEMOS=OFF -DBUILD_OPENGL3_DEMOS=OFF -DBUILD_CPU_DEMOS=OFF -DBUILD_UNIT_TESTS=OFF -DBUILD_BULLET3=OFF -DINSTALL_LIBS=ON \
      -DCMAKE_DISABLE_FIND_PACKAGE_OpenGL=ON
    quietly cmake --build "$build" --parallel "$jobs"
    quietly cmake --install "$build"
  done
}

build_weft() { # build prefix option...
  local build=$1 prefix=$2
  shift 2
  quietly cmake -S "$step_root" -B "$build" "$@" -DWEFT_BUILD_APPS=OFF -DWEFT_BUILD_TESTS=OFF -DWEFT_WITH_IMPORT=OFF -DWEFT_PYTHON=OFF \
    -DWEFT_THREADS=STD -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=30 -DWEFT_PRECOMPILE_HEADERS=ON
  quietly cmake --build "$build" --parallel "$jobs"
  quietly cmake --install "$build" --prefix "$prefix"
}

build_project() { # source build option...
  local source=$1 build=$2
  shift 2
  quietly cmake -S "$source" -B "$build" "$@"
  quietly cmake --build "$build" --parallel "$jobs"
}

build_programs() {
  local component
  build_project tests/install/windows "$folder/core_tests" "${for_windows[@]}" -DGOOGLETEST=/usr/src/googletest
  for component in bridge bridge_float64; do
    build_project tests/install/bits "$folder/bits_$component" "${for_windows[@]}" "-DCOMPONENT=$component"
    build_project tests/install/bits "$folder/native_bits_$component" "${for_this_machine[@]}" "-DCMAKE_PREFIX_PATH=$native" \
      "-DCOMPONENT=$component"
  done
}

# With a folder of links, which a program of Windows cannot make here.
run_tests() {
  cd -- "$folder/core_tests"
  rm -rf links
  mkdir -p links/scene
  printf secret >links/secret
  printf own >links/scene/own
  ln -s ../secret links/scene/link
  ln -s .. links/scene/up
  ln -s own links/scene/inside
  WEFT_TEST_LINKS=links/scene quietly "$wine" ./core_test.exe
}

hash_of() { # program...
  "$@" | tr -d '\r' | sed -n 's/^hash \([0-9a-f]*\)$/\1/p'
}

compare() { # component
  local component=$1 here there
  here=$(hash_of "$folder/native_bits_$component/bits")
  there=$(hash_of "$wine" "$folder/bits_$component/bits.exe")
  echo "$component: ${here:-nothing} here, ${there:-nothing} on Windows"
  [[ -n $here && $here == "$there" ]] || fail "$component: other bits on Windows"
}

compare_all() {
  compare bridge
  compare bridge_float64
}

[[ $(. /etc/os-release && echo "$ID") == debian ]] || not_here "this is not Debian, whose source of Bullet is compiled"
if [[ $if_installed == yes ]]; then
  missing=$("$step_root/tools/setup.sh" --list build windows)
  [[ -z $missing ]] || not_here "these packages are not installed: ${missing//$'\n'/ }"
fi
mkdir -p "$folder"
step "set up" tools/setup.sh build windows
step "get Bullet's source" get_bullet
step "compile Bullet for Windows" build_bullet
step "compile Weft for Windows" build_weft "$folder/weft" "$folder/prefix" "${for_windows[@]}"
if [[ -z $native ]]; then
  native=$folder/native_prefix
  step "compile Weft for this machine" build_weft "$folder/native" "$native" "${for_this_machine[@]}"
fi
step "compile programs" build_programs
step "run tests under Wine" run_tests
step "compare" compare_all
print_step_times
