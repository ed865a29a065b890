# The hot loops, *_kernel.c, are compiled once per variant: each into an object library of its own with its flags and
# TRB_KERNEL_VARIANT=<name>, which makes the names of their functions. The core picks one when it runs. TRB_HAVE_<NAME>=1 tells
# the other sources which of the optional variants exist.
#
#   scalar  plain C, strict arithmetic: what the others are compared with
#   base    vectorised for the instructions that every machine of this architecture has
#   avx2, avx512  the same for x86-64-v3 and v4
#
# -ffast-math lets the compiler vectorise exp, log and pow through glibc's libmvec. It must never reach the link: there it draws in
# crtfastmath.o, which makes the whole process flush denormals to zero.

file(GLOB trb_kernel_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/contact/*_kernel.c
  ${CMAKE_CURRENT_SOURCE_DIR}/stepping/*_kernel.c)
# linear algebra needs no functions of libmvec, and its checks need numbers that may be infinite
set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/stepping/block_kernel.c ${CMAKE_CURRENT_SOURCE_DIR}/stepping/vector_kernel.c
  ${CMAKE_CURRENT_SOURCE_DIR}/contact/modal_kernel.c PROPERTIES COMPILE_OPTIONS "-fno-fast-math")

function(trb_kernel variant)
  add_library(trb_kernel_${variant} OBJECT ${trb_kernel_sources})
  target_include_directories(trb_kernel_${variant} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_compile_definitions(trb_kernel_${variant} PRIVATE TRB_KERNEL_VARIANT=${variant})
  target_compile_options(trb_kernel_${variant} PRIVATE ${ARGN})
  target_link_libraries(trb_kernel_${variant} PRIVATE trb_flags trb_sundials)
  target_sources(trbdyn_core PRIVATE $<TARGET_OBJECTS:trb_kernel_${variant}>)
  string(TOUPPER ${variant} name)
  target_compile_definitions(trbdyn_core PRIVATE TRB_HAVE_${name}=1)
endfunction()

if(trb_kernel_sources)
  include(CheckCCompilerFlag)
  set(fast -O3 -ffast-math)
  trb_kernel(scalar -O2)
  trb_kernel(base ${fast})
  # sanitizers look at the same sources whichever instructions they become
  if(NOT TRB_SANITIZE AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$" AND NOT CMAKE_OSX_ARCHITECTURES MATCHES "arm64")
    check_c_compiler_flag("-march=x86-64-v3" TRB_FLAG_V3)
    check_c_compiler_flag("-march=x86-64-v4 -mprefer-vector-width=512" TRB_FLAG_V4)
    if(TRB_FLAG_V3)
      trb_kernel(avx2 ${fast} -march=x86-64-v3)
    endif()
    if(TRB_FLAG_V4)
      trb_kernel(avx512 ${fast} -march=x86-64-v4 -mprefer-vector-width=512)
    endif()
  endif()
endif()
