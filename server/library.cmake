# oval4d_library(<folder> [USES <folder>…] [LINKS <target>…]): the library oval4d_<folder>, of all sources in this folder
# and those below it. It may include the headers of the folders that it uses, and of those that they use; tests/layers
# checks that it includes no others.
function(oval4d_library folder)
  cmake_parse_arguments(PARSE_ARGV 1 LIBRARY "" "" "USES;LINKS")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  add_library(oval4d_${folder} STATIC ${sources})
  list(TRANSFORM LIBRARY_USES PREPEND oval4d_)
  target_link_libraries(oval4d_${folder} PUBLIC ${LIBRARY_USES} PRIVATE ${LIBRARY_LINKS})
endfunction()
