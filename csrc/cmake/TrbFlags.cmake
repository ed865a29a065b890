# The target trb_flags: warnings and sanitizers for our own sources. Flags of the fast kernels are in TrbKernels.cmake.

add_library(trb_flags INTERFACE)
if(CMAKE_C_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(trb_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wdouble-promotion -Wstrict-prototypes
    -Wmissing-prototypes -Wpointer-arith -Wvla
    -ffunction-sections -fdata-sections)
  if(TRB_WERROR)
    target_compile_options(trb_flags INTERFACE -Werror)
  endif()
  if(TRB_SANITIZE)
    set(sanitizers -fsanitize=address,undefined -fno-omit-frame-pointer)
    target_compile_options(trb_flags INTERFACE ${sanitizers} -fno-sanitize-recover=all -g)
    target_link_options(trb_flags INTERFACE ${sanitizers})
  endif()
endif()
