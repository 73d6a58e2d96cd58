# What makes a mistake in reading a file end the program, instead of letting the file decide what the program does next.
# What each option does is in docs/install.md, "Hardening"; tests/package/hardening.sh finds each in what was built.
# Sanitizers and fuzzers find more, and do not go together with it.
option(PMDSIM_HARDENING "Build with what protects the program against files that were made to harm it" ON)
if(NOT PMDSIM_HARDENING OR PMDSIM_SANITIZE OR PMDSIM_FUZZ)
  return()
endif()

include(CheckCXXCompilerFlag)
foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection)
  string(MAKE_C_IDENTIFIER "takes${flag}" takes)
  check_cxx_compiler_flag(${flag} ${takes}) # the last exists on x86 alone
  if(${takes})
    list(APPEND code ${flag})
  endif()
endforeach()
# Without optimization there is nothing to fortify.
list(APPEND code $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3> -D_GLIBCXX_ASSERTIONS)
# The kernels see no file: who calls them has checked every number, and there it costs up to a quarter of a frame.
target_compile_options(pmdsim_flags INTERFACE "$<$<NOT:$<BOOL:$<TARGET_PROPERTY:PMDSIM_KERNEL>>>:${code}>")
target_link_options(pmdsim_flags INTERFACE LINKER:-z,relro,-z,now LINKER:-z,noexecstack)
# Programs at an address that changes with every start; the library is so in any case.
include(CheckPIESupported)
check_pie_supported(LANGUAGES CXX)
