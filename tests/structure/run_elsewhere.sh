#!/usr/bin/env bash
# run_elsewhere.sh SOURCE EXPECTED RUNNER COMPILER OPTION...: compiles SOURCE by another compiler and runs it, by RUNNER unless that
# is "alone": the program has to print what EXPECTED matches.
set -euo pipefail
source=$1 expected=$2 runner=$3
shift 3
if [[ $runner == alone ]]; then runner=; fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export WINEPREFIX=$(dirname "$source")/wine WINEDEBUG=-all
"$1" -O0 "$source" "${@:2}" -o "$folder/program.exe"
cmake "-DPROGRAM=${runner:+$runner;}$folder/program.exe" "-DEXPECTED=$expected" -P "$(dirname "$0")/run_readme_program.cmake"
