#!/usr/bin/env bash
# single_header.sh ROOT PROGRAM FOLDER COMPILER OPTION...: the source PROGRAM compiles and runs with one header instead of cambium's.
set -euo pipefail
root=$1 program=$2 folder=$3
shift 3
rm -rf "$folder"
mkdir -p "$folder"
cd "$root"
script=examples/packaging/single_header.awk
awk -f $script cambium/cambium.hpp cambium/map/opendrive.hpp >"$folder/single.hpp"
{
  echo '#include "single.hpp"'
  grep -v '#include <cambium/' "$program"
  printf '#ifndef CAMBIUM_SINGLE\n#error "it is not defined"\n#endif\n'
} >"$folder/program.cpp"
"$@" -O0 "$folder/program.cpp" -lpugixml -o "$folder/program"
"$folder/program"
if awk -f $script cambium/nothing.hpp >"$folder/nothing.hpp" 2>"$folder/error.txt"; then
  echo "a header that does not exist is no error"
  exit 1
fi
grep -q "include/cambium/nothing.hpp cannot be read" "$folder/error.txt"
