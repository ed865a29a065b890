# SUNDIALS (CVODE, ARKODE and the serial vector), versions 6.4 to 7.x, as the target trb_sundials.
#
# Tried in this order, static libraries before shared ones:
#   1. SUNDIALS_ROOT (CMake variable or environment)
#   2. find_package(SUNDIALS CONFIG)
#   3. the usual folders of headers and libraries
#   4. unless TRB_SUNDIALS_FETCH is OFF: the static libraries in LLNL's own package on PyPI (pinned by hash), 15 MB
#   5. unless TRB_SUNDIALS_FETCH is OFF: on Debian and kin, the static libraries in libsundials-dev, unpacked without root
# What is found must link into a shared module (sundials_probe), or the next one is tried.
# SUNDIALS_ROOT is an order, not a hint: if it holds no SUNDIALS that works, the build stops.

set(TRB_SUNDIALS_LOWEST 6.4)
set(TRB_SUNDIALS_TOO_HIGH 8)
set(trb_sundials_dir ${CMAKE_CURRENT_LIST_DIR})

# Look for headers and libraries, KIND (static or shared), below the folder HINT (empty: the usual folders). Sets in the
# caller: trb_found, and what the target below needs.
function(trb_sundials_search kind hint)
  set(trb_found FALSE PARENT_SCOPE)
  set(trb_why "no headers and ${kind} libraries" PARENT_SCOPE)
  set(where)
  if(hint)
    set(where HINTS ${hint} NO_DEFAULT_PATH)
  endif()
  set(default_suffixes ${CMAKE_FIND_LIBRARY_SUFFIXES})
  if(kind STREQUAL "static")
    set(CMAKE_FIND_LIBRARY_SUFFIXES .a .lib)
  elseif(WIN32)
    set(CMAKE_FIND_LIBRARY_SUFFIXES .lib .dll.a)
  else()
    set(CMAKE_FIND_LIBRARY_SUFFIXES ${CMAKE_SHARED_LIBRARY_SUFFIX})
  endif()
  set(suffixes lib lib64)
  if(CMAKE_LIBRARY_ARCHITECTURE)
    list(APPEND suffixes lib/${CMAKE_LIBRARY_ARCHITECTURE})
  endif()

  # CVODES holds CVODE and more; either will do
  foreach(solver cvode cvodes)
    unset(header CACHE)
    unset(library CACHE)
    find_path(header ${solver}/${solver}.h ${where} PATH_SUFFIXES include)
    find_library(library NAMES sundials_${solver}_${kind} sundials_${solver} ${where} PATH_SUFFIXES ${suffixes})
    set(found_solver ${solver})
    set(found_header ${header})
    set(found_library ${library})
    unset(header CACHE)
    unset(library CACHE)
    if(found_header AND found_library)
      break()
    endif()
  endforeach()
  if(NOT found_header OR NOT found_library)
    return()
  endif()

  # its version
  set(config ${found_header}/sundials/sundials_config.h)
  if(NOT EXISTS ${config})
    return()
  endif()
  file(STRINGS ${config} line REGEX "^#define SUNDIALS_VERSION ")
  string(REGEX REPLACE ".*\"([0-9.]+).*" "\\1" version "${line}")
  if(version VERSION_LESS TRB_SUNDIALS_LOWEST OR NOT version VERSION_LESS TRB_SUNDIALS_TOO_HIGH)
    set(trb_why "version ${version} is not ${TRB_SUNDIALS_LOWEST} to 7.x" PARENT_SCOPE)
    return()
  endif()

  # the rest from the same folder; which of them exist depends on the version
  get_filename_component(folder ${found_library} DIRECTORY)
  set(libraries ${found_library})
  foreach(name arkode kinsol sunnonlinsolnewton sunnonlinsolfixedpoint sunlinsoldense sunlinsolband sunmatrixdense
               sunmatrixband nvecserial core)
    unset(library CACHE)
    find_library(library NAMES sundials_${name}_${kind} sundials_${name} HINTS ${folder} NO_DEFAULT_PATH)
    if(library)
      list(APPEND libraries ${library})
    elseif(name MATCHES "^(arkode|nvecserial)$" OR (name STREQUAL "core" AND version VERSION_GREATER_EQUAL 7))
      set(trb_why "no ${kind} library sundials_${name} beside ${found_library}" PARENT_SCOPE)
      unset(library CACHE)
      return()
    endif()
    unset(library CACHE)
  endforeach()

  # from 7 on, the core of a SUNDIALS built for MPI needs MPI, used or not
  set(includes ${found_header})
  if(version VERSION_GREATER_EQUAL 7)
    file(STRINGS ${config} mpi REGEX "^#define SUNDIALS_MPI_ENABLED 1")
    if(mpi)
      set(CMAKE_FIND_LIBRARY_SUFFIXES ${default_suffixes})
      find_package(MPI QUIET COMPONENTS C)
      if(NOT MPI_C_FOUND)
        set(trb_why "it was built for MPI, and no MPI was found" PARENT_SCOPE)
        return()
      endif()
      list(APPEND includes ${MPI_C_INCLUDE_DIRS})
      list(APPEND libraries ${MPI_C_LIBRARIES})
    endif()
  endif()

  set(definitions)
  if(found_solver STREQUAL "cvodes")
    set(definitions TRB_SUNDIALS_CVODES=1)
  endif()

  # functions that only its Python bindings would define
  set(sources)
  file(STRINGS ${config} bindings REGEX "^#define SUNDIALS_ENABLE_PYTHON")
  if(bindings AND kind STREQUAL "static")
    set(sources ${trb_sundials_dir}/sundials_bindings.c)
  endif()

  set(probe_dir ${CMAKE_CURRENT_BINARY_DIR}/sundials_probe)
  file(REMOVE_RECURSE ${probe_dir})
  try_compile(links ${probe_dir} ${trb_sundials_dir}/sundials_probe sundials_probe
    CMAKE_FLAGS "-DPROBE_INCLUDES=${includes}" "-DPROBE_DEFINITIONS=${definitions}" "-DPROBE_LIBRARIES=${libraries}"
                "-DPROBE_SOURCES=${sources}"
    OUTPUT_VARIABLE output)
  set(result ${links})
  unset(links CACHE)
  if(NOT result)
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/sundials_probe.log "${found_library}\n${output}")
    set(trb_why "${found_library} does not link into a shared module (see ${CMAKE_CURRENT_BINARY_DIR}/sundials_probe.log)"
        PARENT_SCOPE)
    return()
  endif()

  set(trb_found TRUE PARENT_SCOPE)
  set(trb_version ${version} PARENT_SCOPE)
  set(trb_kind ${kind} PARENT_SCOPE)
  set(trb_includes ${includes} PARENT_SCOPE)
  set(trb_libraries ${libraries} PARENT_SCOPE)
  set(trb_definitions ${definitions} PARENT_SCOPE)
  set(trb_more_sources ${sources} PARENT_SCOPE)
endfunction()

macro(trb_sundials_try origin hint)
  foreach(kind_ static shared)
    if(NOT trb_found)
      trb_sundials_search(${kind_} "${hint}")
      if(trb_found)
        set(trb_origin "${origin}")
      elseif(kind_ STREQUAL "static" OR NOT trb_why MATCHES "^no headers|MPI")
        string(APPEND trb_tried "\n  - ${origin}: ${trb_why}")
      endif()
    endif()
  endforeach()
endmacro()

# LLNL's wheel on PyPI holds include/ and lib64/*.a. Its tag asks for Python 3.12 because of its bindings only, so pip is told
# to fetch it for that version on any Python.
function(trb_sundials_fetch_wheel folder)
  if(NOT EXISTS ${folder}/include/sundials/sundials_config.h)
    file(REMOVE_RECURSE ${folder})
    file(MAKE_DIRECTORY ${folder})
    execute_process(
      COMMAND ${Python_EXECUTABLE} -m pip --disable-pip-version-check download --quiet --retries 2 --no-deps --only-binary=:all:
              --python-version 3.12 --require-hashes --dest ${folder} -r ${trb_sundials_dir}/sundials_wheel.txt
      RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(result)
      string(REGEX MATCH "(ERROR|No module)[^\n]*" line "${output}")
      set(trb_fetch_error "pip could not fetch it: ${line}" PARENT_SCOPE)
      return()
    endif()
    file(GLOB wheel ${folder}/*.whl)
    file(ARCHIVE_EXTRACT INPUT ${wheel} DESTINATION ${folder} PATTERNS "include" "lib*" "*.dist-info")
    file(REMOVE ${wheel})
  endif()
endfunction()

# Debian's libsundials-dev holds headers and position-independent static libraries; apt-get download and dpkg -x need no root
# and bring none of its dependencies.
function(trb_sundials_fetch_deb folder)
  find_program(TRB_APT_GET apt-get)
  find_program(TRB_DPKG dpkg)
  mark_as_advanced(TRB_APT_GET TRB_DPKG)
  if(NOT TRB_APT_GET OR NOT TRB_DPKG)
    set(trb_fetch_error "no apt-get and dpkg here" PARENT_SCOPE)
    return()
  endif()
  if(NOT EXISTS ${folder}/usr/include/sundials/sundials_config.h)
    file(REMOVE_RECURSE ${folder})
    file(MAKE_DIRECTORY ${folder})
    execute_process(COMMAND ${TRB_APT_GET} download libsundials-dev WORKING_DIRECTORY ${folder}
                    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    file(GLOB package ${folder}/*.deb)
    if(result OR NOT package)
      string(REGEX MATCH "E: [^\n]*" line "${output}")
      set(trb_fetch_error "apt-get download libsundials-dev failed: ${line}" PARENT_SCOPE)
      return()
    endif()
    execute_process(COMMAND ${TRB_DPKG} -x ${package} ${folder} COMMAND_ERROR_IS_FATAL ANY)
  endif()
endfunction()

set(trb_found FALSE)
set(trb_tried)

if(NOT SUNDIALS_ROOT AND DEFINED ENV{SUNDIALS_ROOT})
  set(SUNDIALS_ROOT $ENV{SUNDIALS_ROOT})
endif()
if(SUNDIALS_ROOT)
  trb_sundials_try("SUNDIALS_ROOT=${SUNDIALS_ROOT}" "${SUNDIALS_ROOT};${SUNDIALS_ROOT}/usr")
else()
  # a configuration file tells where SUNDIALS is; its targets are not used, as they may want packages that we do not need
  if(NOT TRB_SUNDIALS_ONLY_FETCH)
    set(locate_dir ${CMAKE_CURRENT_BINARY_DIR}/sundials_locate)
    file(REMOVE_RECURSE ${locate_dir})
    execute_process(
      COMMAND ${CMAKE_COMMAND} -S ${trb_sundials_dir}/sundials_locate -B ${locate_dir} -G ${CMAKE_GENERATOR}
              "-DCMAKE_MAKE_PROGRAM=${CMAKE_MAKE_PROGRAM}" "-DCMAKE_PREFIX_PATH=${CMAKE_PREFIX_PATH}"
              "-DCMAKE_LIBRARY_ARCHITECTURE=${CMAKE_LIBRARY_ARCHITECTURE}" "-DSUNDIALS_DIR=${SUNDIALS_DIR}"
      OUTPUT_QUIET ERROR_QUIET)
    set(located)
    if(EXISTS ${locate_dir}/found.txt)
      file(READ ${locate_dir}/found.txt located)
    endif()
    if(located)
      get_filename_component(prefix "${located}/../../.." ABSOLUTE)
      if(CMAKE_LIBRARY_ARCHITECTURE AND prefix MATCHES "/lib$") # below lib/<architecture>/cmake/sundials
        get_filename_component(prefix "${prefix}/.." ABSOLUTE)
      endif()
      trb_sundials_try("find_package, ${located}" "${prefix}")
    endif()
    trb_sundials_try("this system" "")
  endif()
  if(TRB_SUNDIALS_FETCH)
    foreach(route wheel deb)
      if(NOT trb_found)
        set(trb_fetch_error)
        set(folder ${CMAKE_CURRENT_BINARY_DIR}/sundials_${route})
        set(trb_origin_wheel "LLNL's package on PyPI")
        set(trb_origin_deb "the distribution's libsundials-dev, unpacked")
        if(route STREQUAL "wheel")
          trb_sundials_fetch_wheel(${folder})
        else()
          trb_sundials_fetch_deb(${folder})
        endif()
        if(trb_fetch_error)
          string(APPEND trb_tried "\n  - ${trb_origin_${route}}: ${trb_fetch_error}")
        else()
          trb_sundials_try("${trb_origin_${route}}" "${folder};${folder}/usr")
        endif()
      endif()
    endforeach()
  elseif(NOT trb_found)
    string(APPEND trb_tried "\n  - fetching it: switched off by TRB_SUNDIALS_FETCH=OFF")
  endif()
endif()

if(NOT trb_found)
  message(FATAL_ERROR
    "trbdyn needs SUNDIALS ${TRB_SUNDIALS_LOWEST} to 7.x (CVODE and ARKODE). Tried:${trb_tried}\n"
    "Any one of these provides it:\n"
    "  - be online, with pip able to reach PyPI: the build then fetches it by itself (x86-64 Linux, macOS)\n"
    "  - Debian, Ubuntu:  apt-get install --no-install-recommends libsundials-dev\n"
    "  - conda:           conda install -c conda-forge sundials\n"
    "  - Homebrew:        brew install sundials\n"
    "  - your own build:  set SUNDIALS_ROOT to the folder that holds its include and lib\n")
endif()

if(trb_tried)
  message(STATUS "SUNDIALS: tried before:${trb_tried}")
endif()
message(STATUS "SUNDIALS ${trb_version}, ${trb_kind}, from ${trb_origin}")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/sundials.txt "SUNDIALS ${trb_version}, ${trb_kind}, from ${trb_origin}\n")
add_library(trb_sundials INTERFACE)
target_include_directories(trb_sundials SYSTEM INTERFACE ${trb_includes})
target_compile_definitions(trb_sundials INTERFACE ${trb_definitions})
target_link_libraries(trb_sundials INTERFACE ${trb_libraries})
if(trb_more_sources)
  add_library(trb_sundials_bindings STATIC ${trb_more_sources})
  target_link_libraries(trb_sundials INTERFACE trb_sundials_bindings) # after the libraries that call them
endif()
