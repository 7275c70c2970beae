#!/usr/bin/env bash
# From a clone on Debian 12 to a run or a test: installs what is missing, builds, goes.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
build=$root/build/release

# Every Debian 12 package the program and its tests stand on.
packages=(
  g++ cmake ninja-build pkg-config                                  # tools
  libpetsc-real-dev libslepc-real3.18-dev openmpi-bin               # solvers, MPI
  libopenblas0-serial                                               # MUMPS is four times slower with the reference BLAS
  libmetis-dev libeigen3-dev libfmt-dev                             # partition, small matrices, text
  libyaml-cpp-dev nlohmann-json3-dev libcli11-dev                   # deck, results, command line
  libvtk9-dev libegl-dev libgl1-mesa-dri                            # fields and pictures, without a display
  libgmsh-dev                                                       # meshes
  libgtest-dev libbenchmark-dev                                     # tests
)

usage() {
  cat <<'TEXT'
usage: ./bootstrap.sh run DECK [options of `tautline run`]   install, build, run a deck
       ./bootstrap.sh test [options of ctest]                install, build everything, run the tests
       ./bootstrap.sh build                                  install and build only

Leaves the program at build/release/tautline. Calls after the first one go straight to work.
In the environment: TAUTLINE_SKIP_PACKAGES=1 leaves the packages alone (other systems, or libraries of your own);
TAUTLINE_WARNINGS_AS_ERRORS=ON|OFF makes compiler warnings errors or not (OFF, or as the build directory has it);
TAUTLINE_TEST_JOBS is how many tests run at a time.
TEXT
}

say() { printf 'bootstrap: %s\n' "$*" >&2; }
fail() { say "$*"; exit 1; }

# Those packages that are not installed.
missing_packages() {
  comm -13 <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null | sed -n 's/^installed //p' | sort -u) \
           <(printf '%s\n' "${packages[@]}" | sort -u)
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  elif command -v sudo >/dev/null; then
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  else
    fail "installing needs root and there is no sudo. As root: apt-get install --no-install-recommends ${packages[*]}"
  fi
}

check_system() {
  command -v apt-get >/dev/null && command -v dpkg-query >/dev/null && return
  fail "this is no Debian. Install these (Debian's names) by your own means, then call again with
           TAUTLINE_SKIP_PACKAGES=1: ${packages[*]}
           PETSc must be real and double with MUMPS; CMake at least 3.25; VTK 9.1; g++ 12 or another compiler of C++20."
}

install_packages() {
  local missing
  [ "${TAUTLINE_SKIP_PACKAGES:-}" = 1 ] && return
  check_system
  mapfile -t missing < <(missing_packages)
  [ ${#missing[@]} -eq 0 ] && return
  grep -qs 'bookworm' /etc/os-release || say "tried on Debian 12 (bookworm) only; going on with the same package names"
  say "installing ${#missing[@]} packages and what they need: ${missing[*]}"
  as_root apt-get update -q </dev/null >&2 || fail "apt-get update failed: is there a network?"
  as_root apt-get install -y -q --no-install-recommends "${missing[@]}" </dev/null >&2 ||
    fail "apt-get could not install: ${missing[*]}"
}

# Makes the build directory ready, once; ninja looks after it from then on. A clone that was moved starts afresh.
configure() {
  local fresh=() options=(-DTAUTLINE_BUILD_TESTS=ON) warnings=${TAUTLINE_WARNINGS_AS_ERRORS:-}
  [ -z "$warnings" ] || options+=("-DTAUTLINE_WARNINGS_AS_ERRORS=$warnings")
  if [ -f "$build/CMakeCache.txt" ]; then
    if ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt"; then
      fresh=(--fresh)
    elif [ -f "$build/build.ninja" ] && grep -qxF "TAUTLINE_BUILD_TESTS:BOOL=ON" "$build/CMakeCache.txt" &&
      grep -qx "TAUTLINE_WARNINGS_AS_ERRORS:BOOL=${warnings:-.*}" "$build/CMakeCache.txt"; then
      return
    fi
  fi
  say "configuring $build"
  (cd "$root" && cmake --preset release "${fresh[@]}" "${options[@]}") >&2
}

# As many jobs as there are processors, if there is 1.2 GB of memory for each.
jobs() {
  local memory
  memory=$(awk '/^MemAvailable/ {print int($2 / 1.2e6)}' /proc/meminfo 2>/dev/null || true)
  awk -v n="$(nproc)" -v m="${memory:-1}" 'BEGIN {j = m < n ? m : n; print j < 1 ? 1 : j}'
}

# compile [TARGET]: what is out of date. Everything on stderr, so that the output of `run` can be piped.
compile() {
  install_packages
  configure
  say "building with $(jobs) jobs"
  cmake --build "$build" -j "$(jobs)" ${1:+--target "$1"} >&2
}

case ${1:-} in
  run)
    shift
    [ $# -gt 0 ] || { usage >&2; exit 2; }
    compile tautline
    exec "$build/tautline" run "$@"
    ;;
  build)
    compile tautline
    say "the program is $build/tautline"
    ;;
  test)
    shift
    compile
    cd "$root"
    exec ctest --preset release --no-tests=error -j "${TAUTLINE_TEST_JOBS:-$(nproc)}" "$@"
    ;;
  -h | --help | help) usage ;;
  *) usage >&2; exit 2 ;;
esac
