# awk -f examples/packaging/single_header.awk cambium/cambium.hpp cambium/map/opendrive.hpp > single.hpp
# in the repository's folder: one header with these and all that they include. Libraries stay outside. CAMBIUM_SINGLE is defined.

function expand(path,    line, file) {
  if (path in seen) return
  seen[path] = 1
  file = "include/" path
  while ((read = (getline line < file)) > 0) {
    if (line ~ /^#pragma once/) continue
    if (match(line, /^#include "cambium\/[^"]*"/)) {
      expand(substr(line, 11, RLENGTH - 11))
      continue
    }
    print line
  }
  if (read < 0) {
    print "single_header.awk: " file " cannot be read: give headers as they are included, in the repository's folder" > "/dev/stderr"
    failed = 1
    exit 1
  }
  close(file)
}

BEGIN {
  print "#pragma once"
  print "#define CAMBIUM_SINGLE"
  print "#ifdef CAMBIUM_COMPILED"
  print "#error \"the single header of cambium has all code in it: do not link cambium::compiled\""
  print "#endif"
  for (i = 1; i < ARGC; ++i) expand(ARGV[i])
  if (ARGC < 2) expand("cambium/cambium.hpp")
  exit failed
}
