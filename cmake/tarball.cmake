# A source archive that builds without the network: the committed tree, and every crate of Cargo.lock below vendor/.
#
#   cmake [-DOUT=DIR] -P cmake/tarball.cmake     gives DIR/ricci-VERSION.tar.gz
get_filename_component(_source ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
if(NOT OUT)
  set(OUT ${CMAKE_CURRENT_BINARY_DIR})
endif()
file(STRINGS ${_source}/Cargo.toml _version REGEX "^version = " LIMIT_COUNT 1)
string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" _version "${_version}")
set(_name ricci-${_version})
get_filename_component(OUT ${OUT} ABSOLUTE)
file(REMOVE_RECURSE ${OUT}/${_name})
file(MAKE_DIRECTORY ${OUT}/${_name})
find_program(CARGO cargo HINTS $ENV{CARGO_HOME}/bin $ENV{HOME}/.cargo/bin REQUIRED)
execute_process(COMMAND git -C ${_source} archive --format=tar HEAD COMMAND tar -x -C ${OUT}/${_name} COMMAND_ERROR_IS_FATAL ANY)
file(MAKE_DIRECTORY ${OUT}/${_name}/.cargo)
execute_process(COMMAND ${CARGO} vendor --locked --versioned-dirs vendor WORKING_DIRECTORY ${OUT}/${_name}
  OUTPUT_FILE ${OUT}/${_name}/.cargo/config.toml ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -E tar czf ${OUT}/${_name}.tar.gz ${_name} WORKING_DIRECTORY ${OUT} COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${OUT}/${_name})
message(STATUS "${OUT}/${_name}.tar.gz")
