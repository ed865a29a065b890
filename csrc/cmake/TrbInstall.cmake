# Installs libtrbdyn, its header, a package for CMake (find_package(trbdyn)) and one for pkg-config.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/trbdyn)
install(TARGETS trbdyn EXPORT trbdyn PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT trbdyn NAMESPACE trbdyn:: FILE trbdynConfig.cmake DESTINATION ${package})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/trbdynConfigVersion.cmake VERSION ${PROJECT_VERSION}
  COMPATIBILITY SameMinorVersion)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/trbdyn.pc
"prefix=${CMAKE_INSTALL_PREFIX}
libdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}
includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}

Name: trbdyn
Description: dynamics of tapered and cylindrical roller bearings
Version: ${PROJECT_VERSION}
Cflags: -I\${includedir}
Libs: -L\${libdir} -ltrbdyn
")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/trbdynConfigVersion.cmake DESTINATION ${package})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/trbdyn.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
