#!/usr/bin/env bash
# exporting.sh SOURCE FOLDER TYPE CAMBIUM COMPILER: installs the project SOURCE as a library of TYPE (STATIC or SHARED), which
# finds cambium in CAMBIUM, and runs a program that finds the library.
set -euo pipefail
source=$1 folder=$2 type=$3 cambium=$4 compiler=$5
rm -rf "$folder"
options=(-S "$source" "-DCMAKE_CXX_COMPILER=$compiler" "-DCMAKE_PREFIX_PATH=$cambium;$folder/install")
cmake "${options[@]}" -B "$folder/library" "-DSTEPS_TYPE=$type" "-DCMAKE_INSTALL_PREFIX=$folder/install"
cmake --build "$folder/library" --target install
cmake "${options[@]}" -B "$folder/program"
cmake --build "$folder/program"
cd "$folder/program" && ctest --output-on-failure
