# Runs the vcpkg port as a script, with stand-ins for the functions of vcpkg that do what their documentation says on Linux; and
# builds the program in SOURCE against what it installs. vcpkg itself is not run.
file(REMOVE_RECURSE ${WORK})
set(CURRENT_PORT_DIR ${ROOT}/cmake/vcpkg)
set(CURRENT_BUILDTREES_DIR ${WORK}/buildtrees)
set(TARGET_TRIPLET x64-linux)

function(vcpkg_cmake_configure)
  cmake_parse_arguments(PARSE_ARGV 0 _port "" SOURCE_PATH OPTIONS)
  string(COMPARE EQUAL ${VCPKG_LIBRARY_LINKAGE} dynamic _shared)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${_port_SOURCE_PATH} -B ${CURRENT_BUILDTREES_DIR}/rel -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR} -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=${_shared} ${_port_OPTIONS}
    ${CARGO_SETTINGS} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(vcpkg_cmake_install)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${CURRENT_BUILDTREES_DIR}/rel --target install OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(vcpkg_cmake_config_fixup)
  cmake_parse_arguments(PARSE_ARGV 0 _port "" "PACKAGE_NAME;CONFIG_PATH" "")
  file(MAKE_DIRECTORY ${CURRENT_PACKAGES_DIR}/share)
  file(RENAME ${CURRENT_PACKAGES_DIR}/${_port_CONFIG_PATH} ${CURRENT_PACKAGES_DIR}/share/${_port_PACKAGE_NAME})
  file(GLOB _configs ${CURRENT_PACKAGES_DIR}/share/${_port_PACKAGE_NAME}/*.cmake)
  foreach(_config ${_configs})
    file(READ ${_config} _text)
    string(REPLACE "{CMAKE_CURRENT_LIST_DIR}/../../../" "{CMAKE_CURRENT_LIST_DIR}/../../" _text "${_text}")
    file(WRITE ${_config} "${_text}")
  endforeach()
endfunction()

function(vcpkg_fixup_pkgconfig)
endfunction()

function(vcpkg_install_copyright)
  cmake_parse_arguments(PARSE_ARGV 0 _port "" "" FILE_LIST)
  foreach(_file ${_port_FILE_LIST})
    file(READ ${_file} _text)
    file(APPEND ${CURRENT_PACKAGES_DIR}/share/ricci/copyright "${_text}")
  endforeach()
endfunction()

foreach(VCPKG_LIBRARY_LINKAGE dynamic static)
  set(CURRENT_PACKAGES_DIR ${WORK}/${VCPKG_LIBRARY_LINKAGE})
  include(${CURRENT_PORT_DIR}/portfile.cmake)
  file(GLOB _shared ${CURRENT_PACKAGES_DIR}/lib/*.so*)
  file(GLOB _static ${CURRENT_PACKAGES_DIR}/lib/*.a)
  if(NOT EXISTS ${CURRENT_PACKAGES_DIR}/share/ricci/copyright OR (_shared AND _static))
    message(FATAL_ERROR "a port installs its copyright and one library: ${_shared} ${_static}")
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/consumer_${VCPKG_LIBRARY_LINKAGE} -DONE_LIBRARY=ON
    -DCMAKE_PREFIX_PATH=${CURRENT_PACKAGES_DIR} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/consumer_${VCPKG_LIBRARY_LINKAGE} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${WORK}/consumer_${VCPKG_LIBRARY_LINKAGE}/with_ricci COMMAND_ERROR_IS_FATAL ANY)
endforeach()

file(READ ${CURRENT_PORT_DIR}/vcpkg.json _manifest)
string(JSON _version GET "${_manifest}" version)
if(NOT _version STREQUAL VERSION)
  message(FATAL_ERROR "the port is of version ${_version}, the library of ${VERSION}")
endif()
