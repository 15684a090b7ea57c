# `conan create` with the recipe, shared and static, each with the recipe's own test.
find_program(CONAN conan)
if(NOT CONAN)
  message(STATUS "skipped: conan is not installed")
  return()
endif()
file(REMOVE_RECURSE ${WORK})
set(ENV{CONAN_HOME} ${WORK})
string(REGEX MATCH "RICCI_CARGO_TARGET_DIR=([^;]+)" _ "${CARGO_SETTINGS}")
execute_process(COMMAND ${CONAN} profile detect COMMAND_ERROR_IS_FATAL ANY)
# Conan builds a test where it lies.
file(COPY ${ROOT}/cmake/conan/test_package DESTINATION ${WORK})
foreach(_shared True False)
  execute_process(COMMAND ${CONAN} create ${ROOT}/cmake/conan -tf ${WORK}/test_package -o ricci/*:shared=${_shared}
    -c "tools.cmake.cmaketoolchain:extra_variables={'RICCI_CARGO_TARGET_DIR': '${CMAKE_MATCH_1}'}" COMMAND_ERROR_IS_FATAL ANY)
endforeach()
