# A toolchain file for another system: clang, linker and the system's C library as the package ziglang of PyPI brings them.
# Needs TRB_ZIG (the program zig, environment) and TRB_TARGET (environment, such as x86_64-windows-gnu). See .ci/cross.
set(target $ENV{TRB_TARGET})
if(target MATCHES "windows")
  set(CMAKE_SYSTEM_NAME Windows)
elseif(target MATCHES "macos")
  set(CMAKE_SYSTEM_NAME Darwin)
else()
  set(CMAKE_SYSTEM_NAME Linux)
endif()
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR ${target})

set(CMAKE_C_COMPILER $ENV{TRB_ZIG} cc -target ${target})
set(CMAKE_AR $ENV{TRB_ZIG_TOOLS}/ar CACHE FILEPATH "")
set(CMAKE_RANLIB $ENV{TRB_ZIG_TOOLS}/ranlib CACHE FILEPATH "")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_C_COMPILER_WORKS ON)
