# Installs the libraries without their debug information, the headers, the licences, the CMake package and the pkg-config file.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(FILES ${RICCI_LIB_DIR}/${RICCI_STATIC} DESTINATION ${CMAKE_INSTALL_LIBDIR})
set(_shared_dir ${CMAKE_INSTALL_LIBDIR})
if(WIN32)
  set(_shared_dir ${CMAKE_INSTALL_BINDIR})
  install(FILES ${RICCI_LIB_DIR}/${RICCI_IMPORT} DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
install(PROGRAMS ${RICCI_LIB_DIR}/${RICCI_SHARED} DESTINATION ${_shared_dir})
if(CMAKE_STRIP AND NOT MSVC)
  set(_installed "\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}")
  set(_strip_shared --strip-unneeded)
  if(APPLE)
    set(_strip_shared -x)
  endif()
  install(CODE "execute_process(COMMAND \"${CMAKE_STRIP}\" ${_strip_shared}
      \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${_shared_dir}/${RICCI_SHARED}\" COMMAND_ERROR_IS_FATAL ANY)")
  # MinGW's strip takes no archive in which an object is empty, and rustc writes some.
  if(NOT WIN32)
    install(CODE "execute_process(COMMAND \"${CMAKE_STRIP}\" -S \"${_installed}/${RICCI_STATIC}\" COMMAND_ERROR_IS_FATAL ANY)")
  endif()
  if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND CMAKE_OBJCOPY AND CMAKE_NM)
    install(CODE "execute_process(COMMAND \"${CMAKE_COMMAND}\" -DARCHIVE=${_installed}/${RICCI_STATIC} -DSHARED=${_installed}/${RICCI_SHARED}
      -DNM=${CMAKE_NM} -DLD=${CMAKE_LINKER} -DOBJCOPY=${CMAKE_OBJCOPY} -DAR=${CMAKE_AR} -P \"${CMAKE_CURRENT_LIST_DIR}/static.cmake\"
      COMMAND_ERROR_IS_FATAL ANY)")
  endif()
endif()

# Our licences and those of every crate that is linked, from the sources that cargo has built from.
find_package(Python3 COMPONENTS Interpreter)
set(_licences ${PROJECT_BINARY_DIR}/THIRD-PARTY.txt)
if(Python3_FOUND)
  add_custom_command(OUTPUT ${_licences} DEPENDS ${PROJECT_SOURCE_DIR}/Cargo.lock ${CMAKE_CURRENT_LIST_DIR}/licences.py
    COMMAND ${_cargo_env} ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/licences.py ${CARGO} ${PROJECT_SOURCE_DIR} ${_licences} VERBATIM)
  add_custom_target(ricci_licences ALL DEPENDS ${_licences})
  install(FILES ${_licences} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ricci)
else()
  message(STATUS "ricci: Python not found; the licences of linked crates are not installed")
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE-MIT ${PROJECT_SOURCE_DIR}/LICENSE-APACHE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ricci)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ricci)
install(FILES ${PROJECT_SOURCE_DIR}/docs/c-conventions.md ${PROJECT_SOURCE_DIR}/docs/notation.md ${PROJECT_SOURCE_DIR}/docs/bibliography.md
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ricci/docs)
foreach(_link ${RICCI_SHARED_LINKS})
  install(FILES ${RICCI_LIB_DIR}/${_link} DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ricci DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ricci)
set(_shared_names "IMPORTED_SONAME \"${RICCI_SONAME}\"")
if(WIN32)
  set(_shared_names "IMPORTED_IMPLIB \"\${PACKAGE_PREFIX_DIR}/${CMAKE_INSTALL_LIBDIR}/${RICCI_IMPORT}\"")
endif()
configure_package_config_file(cmake/ricci-config.cmake.in ${PROJECT_BINARY_DIR}/ricci-config.cmake
  INSTALL_DESTINATION ${_package_dir}
  PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR _shared_dir)
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
