# A build without any feature has the functions of every header, and those of what was left out say so.
#
# The build is not optimised, so that it is quick, and in a folder of its own.
file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/part/CMakeLists.txt "cmake_minimum_required(VERSION 3.19)
project(part LANGUAGES C)
set(RICCI_FEATURES \"\" CACHE STRING \"none\")
add_subdirectory(${ROOT} ricci)
add_executable(left_out ${SOURCE}/left_out.c)
target_link_libraries(left_out PRIVATE ricci::ricci)
")
execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/part -B ${WORK}/build ${CARGO_SETTINGS} -DRICCI_CARGO_WITH=
  -DRICCI_CARGO_PROFILE=unoptimised -DRICCI_CARGO_TARGET_DIR=${WORK}/cargo OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/build --target left_out OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/build/left_out WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB _shared ${WORK}/build/ricci/lib/libricci.so.*.*.*)
execute_process(COMMAND ${CMAKE_COMMAND} -DNM=${NM} -DREADELF=${READELF} -DLIBRARY=${_shared} -DHEADERS=${ROOT}/include/ricci
  -DSONAME=${SONAME} -P ${CMAKE_CURRENT_LIST_DIR}/exports.cmake COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${WORK})
