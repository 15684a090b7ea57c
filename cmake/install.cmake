# Installs the libraries, the headers, the CMake package and the pkg-config file.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(FILES ${RICCI_LIB_DIR}/${RICCI_STATIC} DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(PROGRAMS ${RICCI_LIB_DIR}/${RICCI_SHARED} DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(_link ${RICCI_SHARED_LINKS})
  install(FILES ${RICCI_LIB_DIR}/${_link} DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ricci DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ricci)
configure_package_config_file(cmake/ricci-config.cmake.in ${PROJECT_BINARY_DIR}/ricci-config.cmake
  INSTALL_DESTINATION ${_package_dir}
  PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR)
# Before 1.0 a new minor version may be incompatible.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ricci-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ricci-config.cmake ${PROJECT_BINARY_DIR}/ricci-config-version.cmake
  DESTINATION ${_package_dir})

list(TRANSFORM RICCI_SYSTEM_LIBS PREPEND "-l" OUTPUT_VARIABLE _private)
list(JOIN _private " " RICCI_PC_LIBS_PRIVATE)
# From the pkgconfig directory up to the prefix, so that an installation can be moved.
file(RELATIVE_PATH RICCI_PC_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/ricci.pc.in ${PROJECT_BINARY_DIR}/ricci.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/ricci.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
