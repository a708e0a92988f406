# Shared by tests/run, examples/run and bench/run, which source it: sets the machine up, configures and builds.
# Prints nothing to standard output, which belongs to the program that is run.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
build=$root/build

# ccache, where it is there: keep what includes precompiled headers, too, and do not preprocess before compiling.
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros} CCACHE_DEPEND=${CCACHE_DEPEND:-1}

note() { printf '%s\n' "$*" >&2; }
fail() {
  note "$*"
  exit 2
}
have() { command -v "$1" >/dev/null 2>&1; }

# one_of WORD LINES: true when WORD is one of the lines. (Not `names | grep -q`: grep ends early, and pipefail minds.)
one_of() { grep -qxF -- "$1" <<<"$2"; }

# have_header FILE...: true when one of them is below the include folder of a usual prefix.
have_header() {
  local prefix header
  local -a prefixes=(/usr /usr/local /opt/homebrew /opt/local ${CONDA_PREFIX:+"$CONDA_PREFIX"})
  IFS=: read -r -a more <<<"${CMAKE_PREFIX_PATH:-}"
  for prefix in "${prefixes[@]}" ${more[@]+"${more[@]}"}; do
    for header in "$@"; do
      if [[ -e $prefix/include/$header ]]; then return 0; fi
    done
  done
  return 1
}

# have_library NAME: whether the linker finds lib<NAME>.
have_library() {
  local folder
  for folder in "${CMAKE_PREFIX_PATH:-}"/lib /usr/lib /usr/lib/*-linux-gnu /usr/lib64 /usr/local/lib /opt/homebrew/lib; do
    if compgen -G "$folder/lib$1.*" >/dev/null; then return 0; fi
  done
  return 1
}

# have_package PACKAGE: looks for what the Debian package brings, wherever it comes from.
have_package() {
  case $1 in
    g++) have "${CXX:-c++}" || have g++ || have clang++ ;;
    cmake) have cmake ;;
    ninja-build) have ninja ;;
    ccache) have ccache ;;
    libeigen3-dev) have_header eigen3/Eigen/Core Eigen/Core ;;
    libboost-dev) have_header boost/version.hpp ;;
    libpugixml-dev) have_header pugixml.hpp ;;
    nlohmann-json3-dev) have_header nlohmann/json.hpp ;;
    libcli11-dev) have_header CLI/CLI.hpp ;;
    libsqlite3-dev) have_header sqlite3.h ;;
    libboost-serialization-dev) have_library boost_serialization ;;
    libboost-mpi-dev) have_header boost/mpi.hpp ;;
    openmpi-bin) have mpirun ;;
    libclang-rt-19-dev) compgen -G '/usr/lib/llvm-19/lib/clang/*/lib/*/libclang_rt.fuzzer*' >/dev/null ;;
    libc++-19-dev) compgen -G '/usr/lib/llvm-19/include/c++/v1/version' >/dev/null ;;
    libc++abi-19-dev) compgen -G '/usr/lib/llvm-19/lib/libc++abi.*' >/dev/null ;;
    g++-mingw-w64-x86-64-posix) have x86_64-w64-mingw32-g++-posix ;;
    wine64) have wine64 || [[ -x /usr/lib/wine/wine64 ]] ;;
    python3-venv) python3 -c 'import ensurepip' 2>/dev/null ;;
    doctest-dev) have_header doctest/doctest.h ;;
    libbenchmark-dev) have_header benchmark/benchmark.h ;;
    *) have "$1" ;;
  esac
}

is_debian() { have apt-get && grep -qE '^ID(_LIKE)?=.*(debian|ubuntu)' /etc/os-release 2>/dev/null; }

as_root() {
  if [[ $(id -u) == 0 ]]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  else
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  fi
}

apt_is_fresh=false
apt_install() {
  if ! $apt_is_fresh; then
    run_quietly as_root apt-get update -qq -o Acquire::Retries=2 -o Acquire::http::Timeout=30 ||
      note "apt-get update failed; going on with the package lists that are here"
    apt_is_fresh=true
  fi
  run_quietly as_root apt-get install -y -qq --no-install-recommends "$@"
}

# run_quietly COMMAND...: its output is shown only when it fails.
run_quietly() {
  local log status=0
  log=$(mktemp)
  "$@" >"$log" 2>&1 </dev/null || status=$?
  if [[ $status != 0 ]]; then cat "$log" >&2; fi
  rm -f "$log"
  return "$status"
}

# ensure_packages PACKAGE...: these, what every build needs, and what makes it quick.
ensure_packages() {
  local package
  local -a missing=() nice=()
  for package in g++ cmake libeigen3-dev libboost-dev libpugixml-dev "$@"; do
    have_package "$package" || missing+=("$package")
  done
  for package in ninja-build ccache; do
    have_package "$package" || nice+=("$package")
  done
  if ! is_debian && ! have ninja && ! have make; then missing+=(ninja-build); fi
  if [[ ${#missing[@]} == 0 ]] && { [[ ${#nice[@]} == 0 ]] || ! is_debian; }; then return; fi

  if ! is_debian; then
    fail "missing, to be installed by you (names of the Debian packages): ${missing[*]}"
  fi
  if [[ $(id -u) != 0 ]] && ! have sudo; then
    if [[ ${#missing[@]} == 0 ]]; then return; fi
    fail "missing packages, and neither root nor sudo to install them: apt-get install ${missing[*]}"
  fi
  note "installing ${missing[*]} ${nice[*]}"
  for package in ${nice[@]+"${nice[@]}"}; do
    apt_install "$package" || note "going on without $package"
  done
  if [[ ${#missing[@]} != 0 ]]; then
    apt_install "${missing[@]}" || fail "apt-get could not install ${missing[*]}"
  fi
}

# need_compiler: where g++ is older than 12, g++-12 beside it, as on Ubuntu 22.04; not where the user has chosen one.
need_compiler() {
  local version
  if [[ -n ${CXX:-} ]] || ! have g++; then return; fi
  version=$(g++ -dumpversion)
  if [[ ${version%%.*} -ge 12 ]]; then return; fi
  if ! have g++-12; then
    { is_debian && apt_install g++-12; } || fail "g++ $version is too old: install g++-12 or clang++ and set CXX to it"
  fi
  export CXX=g++-12
}

# try_packages PACKAGE...: goes on without those that cannot be had.
try_packages() {
  local package
  for package in "$@"; do
    if have_package "$package" || ! is_debian; then continue; fi
    note "installing $package"
    apt_install "$package" >/dev/null 2>&1 || note "going on without $package"
  done
}

# check_owner: one sentence, not a compiler's complaint, where this user may not build here.
check_owner() {
  local place=$build
  if [[ ! -e $build ]]; then place=$root; fi
  if [[ ! -w $place ]] || { [[ -e $build/CMakeCache.txt ]] && [[ ! -w $build/CMakeCache.txt ]]; }; then
    fail "$place belongs to $(stat -c %U "$place" 2>/dev/null || echo another user) and cannot be written to by $(id -un): build in a copy of the checkout that is yours, or make it writable"
  fi
}

# check_compiler: a build folder keeps its compiler, whatever CXX says later.
check_compiler() {
  local own wanted
  own=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt" 2>/dev/null) || true
  if [[ -z $own || -z ${CXX:-} || $CXX == *" "* ]]; then return; fi
  wanted=$(command -v "$CXX" || echo "$CXX")
  if [[ $wanted != "$own" ]]; then fail "$build compiles with $own, but CXX is $CXX: unset CXX, or remove that folder"; fi
}

cache_says() { grep -qxF "$1" "$build/CMakeCache.txt" 2>/dev/null; }

# is_configured PART: build/ is this checkout's, optimised, and has PART (TESTS, BENCH or EXAMPLES) on.
is_configured() {
  [[ -e $build/.configured_$1 ]] && cache_says "CAMBIUM_BUILD_$1:BOOL=ON" &&
    cache_says "CMAKE_BUILD_TYPE:STRING=Release" && cache_says "CMAKE_HOME_DIRECTORY:INTERNAL=$root"
}

more_cmake_options=()  # of the caller

# configure PART PACKAGE...: packages, then CMake; does nothing when that is done already. Tests run examples, too.
configure() {
  local part=$1
  shift
  check_owner
  check_compiler
  if is_configured "$part"; then return; fi
  ensure_packages "$@"
  need_compiler

  local -a options=(-DCMAKE_BUILD_TYPE=Release "-DCAMBIUM_BUILD_$part=ON")
  if [[ -e $build/CMakeCache.txt ]] && ! cache_says "CMAKE_HOME_DIRECTORY:INTERNAL=$root"; then
    rm -rf "$build"  # a copy of another checkout's
  fi
  if [[ ! -e $build/CMakeCache.txt ]]; then
    local other
    for other in TESTS BENCH EXAMPLES; do
      if [[ $other != "$part" ]]; then options+=("-DCAMBIUM_BUILD_$other=OFF"); fi
    done
    if have ninja; then options+=(-G Ninja); fi
    if have ccache; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  fi
  if [[ $part == TESTS ]]; then
    if ! have ccache; then options+=("-DCMAKE_CXX_COMPILER_LAUNCHER=$root/tests/timed"); fi
    options+=(-DCAMBIUM_BUILD_EXAMPLES=ON "-DCAMBIUM_QUICK_TESTS=${quick:-OFF}"
      "-DCAMBIUM_INSTALL_COMPILED=$([[ ${quick:-OFF} == ON ]] && echo OFF || echo ON)" "-DCMAKE_CXX_LINKER_LAUNCHER=$root/tests/timed")
  fi
  rm -f "$build/.configured_$part"
  note "configuring"
  run_quietly cmake -S "$root" -B "$build" "${options[@]}" ${more_cmake_options[@]+"${more_cmake_options[@]}"} || exit 1
  touch "$build/.configured_$part"
}

# build_target TARGET...
build_target() {
  run_quietly cmake --build "$build" --target "$@" --parallel "$(getconf _NPROCESSORS_ONLN)" || exit 1
}
