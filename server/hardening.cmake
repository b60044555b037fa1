# Compiler and linker flags, for all targets, that make a memory error in the program harder to exploit. Flags that the
# compiler or the linker does not support are left out, such as those for another processor.
include(CheckCXXCompilerFlag)
include(CheckLinkerFlag)

set(CMAKE_REQUIRED_FLAGS -Werror) # Clang only warns about a flag for another processor, so the check needs errors

# Stack protector: functions with arrays detect an overwritten return address. Control-flow protection: indirect jumps
# may lead only to marked instructions (Intel CET; BTI and pointer authentication on ARM).
foreach(flag -fstack-protector-strong -fcf-protection=full -mbranch-protection=standard)
  string(MAKE_C_IDENTIFIER "compiler${flag}" known)
  check_cxx_compiler_flag(${flag} ${known})
  if(${known})
    add_compile_options(${flag})
  endif()
endforeach()
unset(CMAKE_REQUIRED_FLAGS)

# The C library checks calls that write to memory (memcpy, sprintf ...) if the compiler knows the size of the buffer.
# The compiler finds out this size only when it optimizes. Sanitizers make the same checks more thoroughly, but only if
# the C library does not check first, so these flags are omitted with sanitizers.
if(NOT OVAL4D_SANITIZE)
  add_compile_options("$<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3>")
endif()

# Executables are position-independent, so their address differs at each start. The static libraries use -fPIE instead
# of CMake's -fPIC, which keeps the compiler from inlining functions that another shared library might replace.
add_compile_options("$<$<NOT:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>>:-fPIE>")
add_link_options("$<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie>")

# relro, now: the dynamic linker resolves all functions at startup, and their addresses are read-only from then on.
# as-needed: unused libraries are not loaded. noexecstack: the stack is not executable. ibt, shstk: the program is
# marked as compatible with -fcf-protection even if an object file of the C library lacks that mark.
foreach(flag -z,relro -z,now --as-needed -z,noexecstack -z,ibt -z,shstk)
  string(MAKE_C_IDENTIFIER "linker${flag}" known)
  check_linker_flag(CXX "-Wl,--fatal-warnings,${flag}" ${known}) # GNU ld only warns about an unknown -z
  if(${known})
    add_link_options("LINKER:${flag}")
  endif()
endforeach()
