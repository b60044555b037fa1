# What compiler and linker do so that a fault in the program is harder to make use of. All targets are built so; a flag
# that the compiler or the linker does not know, as those of another processor, is left out.
include(CheckCXXCompilerFlag)
include(CheckLinkerFlag)

set(CMAKE_REQUIRED_FLAGS -Werror) # Clang only warns of a flag for another processor

# The return address is guarded in functions with arrays; indirect jumps end only at places that are marked for them.
foreach(flag -fstack-protector-strong -fcf-protection=full -mbranch-protection=standard)
  string(MAKE_C_IDENTIFIER "compiler${flag}" known)
  check_cxx_compiler_flag(${flag} ${known})
  if(${known})
    add_compile_options(${flag})
  endif()
endforeach()
unset(CMAKE_REQUIRED_FLAGS)

# Calls of the C library that write to memory are checked where the compiler knows how much there is, which it does only
# when it optimizes. Sanitizers check the same, and better, unless the library does before them.
if(NOT OVAL4D_SANITIZE)
  add_compile_options("$<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3>")
endif()

# Programs lie at an address that differs at each start. Not -fPIC, which CMake would take for static libraries: it keeps
# the compiler from inlining functions that another library might replace.
add_compile_options("$<$<NOT:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>>:-fPIE>")
add_link_options("$<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie>")

# All addresses of functions are looked up at the start, and read-only from then on; libraries that nothing is used of are
# not loaded; the stack holds no code. The C library's own object files may lack the mark of -fcf-protection, by which the
# linker would take it from the program.
foreach(flag -z,relro -z,now --as-needed -z,noexecstack -z,ibt -z,shstk)
  string(MAKE_C_IDENTIFIER "linker${flag}" known)
  check_linker_flag(CXX "-Wl,--fatal-warnings,${flag}" ${known}) # GNU's only warns of a -z that it does not know
  if(${known})
    add_link_options("LINKER:${flag}")
  endif()
endforeach()
