#!/usr/bin/env bash
# same_bits.sh SOURCE INCLUDE EIGEN FOLDER COMPILER...: passes when the program SOURCE prints the same from each compiler, for this
# processor, without its fused operations, with another C and C++ library (musl and libc++ of ziglang, from PyPI), and as a program
# of Windows, by MinGW's g++, under Wine. INCLUDE has cambium's headers, EIGEN Eigen's. Says what it leaves out because it is missing
# here.
set -euo pipefail
source=$1 include=$2 eigen=$3 folder=$4
shift 4
mkdir -p "$folder"
cd "$folder"
rm -rf first.txt boost_alone
mkdir boost_alone # without the headers of this system's C library beside it
export ZIG_GLOBAL_CACHE_DIR=$PWD/zig_cache ZIG_LOCAL_CACHE_DIR=$PWD/zig_cache
options=(-std=c++20 -ffp-contract=off -DCAMBIUM_FLATTEN= "-I$include" -isystem "$eigen" "$source" -o program)

# compare WHAT COMMAND...: whether the command prints what the first one printed.
compare() {
  local what=$1
  shift
  "$@" >printed.txt
  if [[ ! -e first.txt ]]; then mv printed.txt first.txt; fi
  if [[ -e printed.txt ]] && ! cmp -s first.txt printed.txt; then
    echo "different: $what"
    diff first.txt printed.txt | head -n 20 || true
    exit 1
  fi
  echo "$what: $(cksum <first.txt)"
}

for compiler in "$@"; do
  "$compiler" -O2 "${options[@]}"
  compare "$compiler" ./program
  if [[ $compiler == "$1" ]]; then
    compare "$compiler, glibc without FMA and AVX2" \
      env GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-FMA_Usable,-FMA4_Usable,-AVX2_Usable ./program
    "$compiler" -O3 -march=native "${options[@]}"
    compare "$compiler -O3 -march=native" ./program
  fi
done

boost=/usr/include/boost
if [[ -d $boost ]] && { [[ -x python/bin/python ]] || python3 -m venv python; } &&
  python/bin/python -m pip install -q --disable-pip-version-check ziglang==0.17.1; then
  ln -s "$boost" boost_alone
  python/bin/python -m ziglang c++ -target "$(uname -m)-linux-musl" -O2 -isystem boost_alone "${options[@]}"
  compare "clang with musl and libc++" ./program
else
  echo "left out: musl and libc++, since ziglang or Boost is not to be had here"
fi

wine=$(command -v wine64 || command -v /usr/lib/wine/wine64 || true)
if [[ -n $wine && -d $boost ]] && command -v x86_64-w64-mingw32-g++-posix >/dev/null; then
  ln -sfn "$boost" boost_alone/boost
  x86_64-w64-mingw32-g++-posix -O2 -static -Wa,-mbig-obj -isystem boost_alone "${options[@]}"
  export WINEPREFIX=$PWD/wine WINEDEBUG=-all
  # fma of MinGW before version 11 rounds twice, and with it random numbers.
  random='^(idm_stochastic|pedestrian) '
  grep -vE "$random" first.txt >calm.txt && mv calm.txt first.txt
  compare "MinGW's g++ under Wine, but for random numbers" bash -c "'$wine' ./program.exe | tr -d '\r' | grep -vE '$random'"
else
  echo "left out: Windows, since MinGW's g++ (g++-mingw-w64-x86-64-posix) or Wine (wine64) is missing here"
fi
