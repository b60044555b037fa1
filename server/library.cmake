# oval4d_library(<folder> [USES <folder>…] [LINKS <target>…]): adds the static library oval4d_<folder>, built from all
# sources in the current folder and its subfolders. USES: the folders whose headers these sources may include. They may
# also include headers of the folders that those folders use; tests/layers checks that they include no others. LINKS:
# targets to link privately.
function(oval4d_library folder)
  cmake_parse_arguments(PARSE_ARGV 1 LIBRARY "" "" "USES;LINKS")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  add_library(oval4d_${folder} STATIC ${sources})
  list(TRANSFORM LIBRARY_USES PREPEND oval4d_)
  target_link_libraries(oval4d_${folder} PUBLIC ${LIBRARY_USES} PRIVATE ${LIBRARY_LINKS})
endfunction()
