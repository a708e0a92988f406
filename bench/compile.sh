#!/usr/bin/env bash
# compile.sh FLAGS: seconds to compile one translation unit with g++ -O2, minimum of three, against the budgets; and two
# whole programs of the README, which have none.
set -euo pipefail
flags=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# measure NAME BUDGET PROGRAM [TIMES]: prints one line of the table; BUDGET - is none.
measure() {
  local name=$1 budget=$2 times=${4:-3} source=$folder/unit.cpp best='' seconds
  printf '%s\n' "$3" >"$source"
  for ((; times > 0; times--)); do
    local TIMEFORMAT=%R
    seconds=$({ time g++ "@$flags" -O2 -c -o "$folder/unit.o" "$source" >"$folder/log" 2>&1; } 2>&1) || {
      printf '%-22s does not compile: %s\n' "$name" "$(grep -m 1 -i error "$folder/log" || true)"
      return
    }
    if [[ -z $best ]] || awk "BEGIN { exit !($seconds < $best) }"; then best=$seconds; fi
  done
  if [[ $budget == - ]]; then
    printf '%-22s %6.2f s\n' "$name" "$best"
    return
  fi
  awk -v n="$name" -v s="$best" -v b="$budget" \
    'BEGIN { printf "%-22s %6.2f s   budget %3.0f s   %s\n", n, s, b, s <= b ? "kept" : "EXCEEDED" }'
}

g++ --version | head -n 1
measure geometry 2 '#include <cambium/geometry.hpp>'
measure map 3 '#include <cambium/map.hpp>'
measure world 6 "$(cat "$(dirname "${BASH_SOURCE[0]}")/compile_world.cpp")"
measure planner 6 "$(cat "$(dirname "${BASH_SOURCE[0]}")/compile_planner.cpp")"
measure umbrella 6 '#include <cambium/cambium.hpp>'
# program NUMBER: of those in the README that run.
program() {
  awk -v n="$1" '/<!-- runs -->/ { k++ } /^```/ { on = 0 } on && k == n; /^```cpp/ { on = 1 }' \
    "$(dirname "${BASH_SOURCE[0]}")/../README.md"
}
measure "README: world" - "$(program 1)" 1
measure "README: planner" - "$(program 3)" 1
