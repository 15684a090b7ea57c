# Installs BUILD below WORK, moves the installation, and builds SOURCE and EXAMPLES against it with CMake and with
# pkg-config, without Rust on the path; without the installation they are not built.
set(ENV{PATH} /usr/local/bin:/usr/bin:/bin)
find_program(_cargo cargo PATHS ENV PATH NO_DEFAULT_PATH)
if(_cargo)
  message(FATAL_ERROR "there is a Rust toolchain on the path: ${_cargo}")
endif()
file(REMOVE_RECURSE ${WORK})
set(_prefix ${WORK}/moved)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first OUTPUT_QUIET
  COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${WORK}/first ${_prefix})

execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/consumer -DCMAKE_PREFIX_PATH=${_prefix}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/consumer COMMAND_ERROR_IS_FATAL ANY)
foreach(_program with_shared with_static)
  execute_process(COMMAND ${WORK}/consumer/${_program} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

execute_process(COMMAND ${CMAKE_COMMAND} -S ${EXAMPLES} -B ${WORK}/examples -DCMAKE_PREFIX_PATH=${_prefix}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/examples COMMAND_ERROR_IS_FATAL ANY)
foreach(_program example_openmesh example_eigen)
  if(EXISTS ${WORK}/examples/${_program})
    execute_process(COMMAND ${WORK}/examples/${_program} ${MESH} COMMAND_ERROR_IS_FATAL ANY)
  endif()
endforeach()
foreach(_source ${SOURCE} ${EXAMPLES})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${_source} -B ${WORK}/without RESULT_VARIABLE _result OUTPUT_QUIET ERROR_QUIET)
  if(_result EQUAL 0)
    message(FATAL_ERROR "${_source} was configured without an installation")
  endif()
  file(REMOVE_RECURSE ${WORK}/without)
endforeach()

find_program(PKG_CONFIG pkg-config)
if(NOT PKG_CONFIG)
  message(STATUS "pkg-config is not installed; its test is left out")
  return()
endif()
set(ENV{PKG_CONFIG_PATH} ${_prefix}/${LIBDIR}/pkgconfig)
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs ricci OUTPUT_VARIABLE _flags
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(_flags)
execute_process(COMMAND ${CC} ${SOURCE}/main.c -o ${WORK}/with_pkg_config ${_flags}
  -Wl,-rpath,${_prefix}/${LIBDIR} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/with_pkg_config COMMAND_ERROR_IS_FATAL ANY)
find_path(_eigen Eigen/Core PATH_SUFFIXES eigen3)
if(_eigen)
  execute_process(COMMAND ${CXX} -std=c++14 -isystem ${_eigen} ${EXAMPLES}/eigen.cpp -o ${WORK}/eigen ${_flags}
    -Wl,-rpath,${_prefix}/${LIBDIR} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${WORK}/eigen ${MESH} COMMAND_ERROR_IS_FATAL ANY)
endif()
set(ENV{PKG_CONFIG_PATH} "")
execute_process(COMMAND ${PKG_CONFIG} --exists ricci RESULT_VARIABLE _result)
if(_result EQUAL 0)
  message(FATAL_ERROR "pkg-config finds a ricci that was not installed here")
endif()
