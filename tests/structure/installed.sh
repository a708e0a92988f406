#!/usr/bin/env bash
# installed.sh SOURCE PREFIX COMPILER...: passes when what is installed below PREFIX are the headers of SOURCE, all of them
# and nothing else, and the licence, and each compiler builds a program with the flags of pkg-config, which knows every target.
set -euo pipefail
source=$1
prefix=$2
shift 2

diff <(cd "$source/include" && find . -name '*.hpp' -o -name '*.h' | sort) <(cd "$prefix/include" && find . -type f | sort)
cmp "$source/LICENSE" "$prefix/share/doc/cambium/LICENSE"

if ! command -v pkg-config >/dev/null; then
  echo "skipped: no pkg-config here"
  exit 0
fi
export PKG_CONFIG_PATH=$prefix/share/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
for part in geometry map opendrive json benchmark benchmark_main snapshot; do
  pkg-config --cflags --libs "cambium-$part" >/dev/null
done
flags=$(pkg-config --cflags --libs cambium-opendrive 2>/dev/null)
for compiler in "$@"; do
  # shellcheck disable=SC2086  # flags are words
  "$compiler" -std=c++20 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror "$source/tests/structure/consumer/main.cpp" \
    $flags -o "$prefix/consumer"
  "$prefix/consumer"
done
rm -f "$prefix/consumer"
