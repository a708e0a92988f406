#!/usr/bin/env bash
# two_versions.sh STEPS INCLUDE FOLDER COMPILER OPTION...: two shared libraries of one source, STEPS, of which each has a version
# of cambium in it that drives differently, keep to theirs in one program.
set -euo pipefail
steps=$1 include=$2 folder=$3
shift 3
rm -rf "$folder"
mkdir -p "$folder"
cp -r "$include" "$folder/next"
grep -rlZ v0_1 "$folder/next" | xargs -0 sed -i 's/v0_1/v0_2/g'
sed -i 's/double acceleration = 0.0;/double acceleration = 1.0;/' "$folder/next/cambium/behavior/open_loop/constant_acceleration.hpp"
"$@" -O0 -fPIC -shared "-I$include" -Dplace_after_a_second=one "$steps" -o "$folder/libone.so"
"$@" -O0 -fPIC -shared "-I$folder/next" -Dplace_after_a_second=two "$steps" -o "$folder/libtwo.so"
cat >"$folder/main.cpp" <<'END'
#include <cstdio>
double one(double speed);
double two(double speed);
int main() { std::printf("%g %g\n", one(20.0), two(20.0)); }
END
"$1" "$folder/main.cpp" "-L$folder" -lone -ltwo "-Wl,-rpath,$folder" -o "$folder/program"
printed=$("$folder/program")
if [[ $printed != "30 30.5" ]]; then
  echo "printed '$printed' instead of '30 30.5': a version took the other's code"
  exit 1
fi
