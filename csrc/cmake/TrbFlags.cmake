# The target trb_flags: warnings and sanitizers for our own sources. Flags of the fast kernels are in TrbKernels.cmake.

# the core refuses values that are not finite, and its sums are ordered: arithmetic that assumes otherwise would accept NaN
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
set(CMAKE_REQUIRED_FLAGS "${CMAKE_C_FLAGS_${build_type}}")
include(CheckCSourceCompiles)
unset(TRB_EXACT_MATH CACHE) # the flags may have changed
check_c_source_compiles("
#if defined(__FAST_MATH__) || defined(_M_FP_FAST) || defined(__ASSOCIATIVE_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error fast math
#endif
int main(void) { return 0; }" TRB_EXACT_MATH)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT TRB_EXACT_MATH)
  set(flags "${CMAKE_C_FLAGS} ${CMAKE_C_FLAGS_${build_type}}")
  message(FATAL_ERROR "the compiler's flags (${flags}) allow fast math, or the compiler does not work: "
    "take away -ffast-math, -Ofast, -ffinite-math-only, -funsafe-math-optimizations or /fp:fast")
endif()

add_library(trb_flags INTERFACE)
if(CMAKE_C_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(trb_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wdouble-promotion -Wstrict-prototypes
    -Wmissing-prototypes -Wpointer-arith -Wvla
    -ffunction-sections -fdata-sections)
  if(CMAKE_C_COMPILER_ID MATCHES "Clang")
    # numbers of choices are kept among those of the parameters, all of them double; NAN and INFINITY are of the type float
    target_compile_options(trb_flags INTERFACE -Wno-unknown-warning-option -Wno-enum-float-conversion -Wno-double-promotion)
  endif()
  if(TRB_WERROR)
    target_compile_options(trb_flags INTERFACE -Werror)
  endif()
  if(TRB_SANITIZE)
    set(sanitizers -fsanitize=address,undefined -fno-omit-frame-pointer)
    target_compile_options(trb_flags INTERFACE ${sanitizers} -fno-sanitize-recover=all -g)
    target_link_options(trb_flags INTERFACE ${sanitizers})
  endif()
endif()

# see base/windows_memory.h
if(WIN32)
  if(MSVC)
    target_compile_options(trb_flags INTERFACE /FI${CMAKE_CURRENT_SOURCE_DIR}/base/windows_memory.h)
  else()
    target_compile_options(trb_flags INTERFACE -include ${CMAKE_CURRENT_SOURCE_DIR}/base/windows_memory.h)
  endif()
endif()
