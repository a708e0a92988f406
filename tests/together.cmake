# cmake -D OUT=FILE -D SOURCES=LIST -P together.cmake: a source of several tests, each in a namespace of its own. The headers
# of all come first; so where a test includes them, in its namespace, there is nothing left of them.
set(headers "")
set(tests "")
foreach(source IN LISTS SOURCES)
  file(STRINGS "${source}" lines REGEX "^#include ")
  list(TRANSFORM lines REPLACE "#include ([^ ]+).*" "#if __has_include(\\1)\n#include \\1\n#endif")  # some systems lack some
  list(APPEND headers ${lines})
  get_filename_component(name "${source}" NAME_WE)
  string(APPEND tests "\nnamespace ${name} {\n#include \"${source}\"\n}\n")
  file(STRINGS "${source}" macros REGEX "^#define ")
  list(TRANSFORM macros REPLACE "#define ([A-Za-z_0-9]+).*" "#undef \\1")
  list(REMOVE_DUPLICATES macros)
  list(JOIN macros "\n" macros)
  string(APPEND tests "${macros}\n")
endforeach()
list(REMOVE_DUPLICATES headers)
list(JOIN headers "\n" headers)
file(WRITE "${OUT}" "${headers}\n${tests}")
