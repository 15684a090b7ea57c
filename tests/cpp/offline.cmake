# The archive of cmake/tarball.cmake builds where nothing can be fetched: without a network, and with a CARGO_HOME that has no crate; with
# everything, and without any feature.
#
# The builds are not optimised, so that they are quick.
find_program(GIT git)
if(NOT GIT OR NOT EXISTS ${ROOT}/.git)
  message(STATUS "skipped: archives are made of a git checkout, and this is none")
  return()
endif()
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CMAKE_COMMAND} -DOUT=${WORK} -P ${ROOT}/cmake/tarball.cmake COMMAND_ERROR_IS_FATAL ANY)
file(GLOB _archive ${WORK}/ricci-*.tar.gz)
file(SIZE ${_archive} _size)
message(STATUS "${_archive}: ${_size} bytes")
file(ARCHIVE_EXTRACT INPUT ${_archive} DESTINATION ${WORK})
file(GLOB _source ${WORK}/ricci-*.*.?)

file(MAKE_DIRECTORY ${WORK}/home)
set(ENV{CARGO_HOME} ${WORK}/home)
unset(ENV{CARGO_TARGET_DIR})
set(_alone unshare --map-root-user --net)
execute_process(COMMAND ${_alone} true RESULT_VARIABLE _together OUTPUT_QUIET ERROR_QUIET)
if(NOT _together EQUAL 0)
  message(STATUS "the network cannot be taken away here (unshare): cargo is only told not to use it")
  set(_alone)
endif()
execute_process(COMMAND ${_alone} ${CMAKE_COMMAND} -S ${_source} -B ${WORK}/build -DRICCI_CARGO_OFFLINE=ON
  -DRICCI_CARGO_PROFILE=unoptimised -DRICCI_CARGO_TARGET_DIR=${WORK}/cargo -DRICCI_CARGO_WITH=ricci-apps -DRICCI_TESTS=OFF
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${_alone} ${CMAKE_COMMAND} --build ${WORK}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/build/examples/c/example_flow WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)

# The golden vectors have the bits of the optimised build, where there is one of the command.
if(EXISTS ${RICCI})
  execute_process(COMMAND ${ROOT}/tests/vectors/bits ${WORK}/cargo/unoptimised/ricci ${RICCI} COMMAND_ERROR_IS_FATAL ANY)
endif()

# A build without any feature, by the same archive and from the same crates, has the functions of every header, and those of what was left out
# say so. Builds that are not optimised have debug assertions: a second release is refused.
file(WRITE ${WORK}/part/CMakeLists.txt "cmake_minimum_required(VERSION 3.19)
project(part LANGUAGES C)
set(RICCI_FEATURES \"\" CACHE STRING \"none\")
add_subdirectory(${_source} ricci)
add_executable(left_out ${SOURCE}/left_out.c)
target_link_libraries(left_out PRIVATE ricci::ricci)
")
execute_process(COMMAND ${_alone} ${CMAKE_COMMAND} -S ${WORK}/part -B ${WORK}/parts -DRICCI_CARGO_OFFLINE=ON -DCARGO=${CARGO}
  -DRICCI_CARGO_PROFILE=unoptimised -DRICCI_CARGO_TARGET_DIR=${WORK}/cargo OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${_alone} ${CMAKE_COMMAND} --build ${WORK}/parts --target left_out OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/parts/left_out WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)
if(NM AND READELF)
  file(GLOB _shared ${WORK}/parts/ricci/lib/libricci.so.*.*.*)
  execute_process(COMMAND ${CMAKE_COMMAND} -DNM=${NM} -DREADELF=${READELF} -DLIBRARY=${_shared} -DHEADERS=${ROOT}/include/ricci
    -DSONAME=${SONAME} -P ${CMAKE_CURRENT_LIST_DIR}/exports.cmake COMMAND_ERROR_IS_FATAL ANY)
endif()
file(REMOVE_RECURSE ${WORK})
