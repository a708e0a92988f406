#!/usr/bin/env bash
# wrong.sh SOURCE COMPILER...: passes when every compiler, a command and its options with | between them, rejects SOURCE
# with the phrase of its first line, `// expect: <phrase>`, and with no other sentence of cambium's, but for that of a line
# `// also: <phrase>`.
set -euo pipefail
source=$1
shift

first=$(head -n 1 "$source")
phrase=${first#// expect: }
if [[ $phrase == "$first" || -z $phrase ]]; then
  echo "$source: the first line must be '// expect: <phrase>'"
  exit 1
fi

also=$(sed -n '2s,^// also: ,,p' "$source")
also=${also:-$phrase}
for compiler in "$@"; do
  IFS='|' read -r -a words <<<"$compiler"
  compiler=${words[0]}
  if output=$("${words[@]}" "$source" 2>&1); then
    echo "$source: $compiler: it compiles, but must not"
    exit 1
  fi
  if [[ $output != *"$phrase"* ]]; then
    printf '%s\n' "$output" "$source: $compiler: it is rejected, but the compiler does not say '$phrase'"
    exit 1
  fi
  others=$(grep -E '(static assertion failed|static_assert failed).*cambium' <<<"$output" | grep -vF "$phrase" |
    grep -vF "$also") || true
  if [[ -n $others ]]; then
    printf '%s\n' "$output" "$source: $compiler: it says another sentence, too:" "$others"
    exit 1
  fi
done
