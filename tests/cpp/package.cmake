# Installs BUILD below WORK, moves the installation, and builds SOURCE against it with CMake and with
# pkg-config.
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
