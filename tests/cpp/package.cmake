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
foreach(_program example_openmesh example_eigen example_spline)
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

# As a part of another build: FetchContent and add_subdirectory.
file(WRITE ${WORK}/part/CMakeLists.txt "cmake_minimum_required(VERSION 3.19)
project(part LANGUAGES C)
include(FetchContent)
FetchContent_Declare(ricci SOURCE_DIR ${ROOT})
FetchContent_MakeAvailable(ricci)
add_executable(part ${SOURCE}/main.c)
target_link_libraries(part PRIVATE ricci::ricci)
")
foreach(_shared ON OFF)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/part -B ${WORK}/part_${_shared} -DBUILD_SHARED_LIBS=${_shared} ${CARGO_SETTINGS}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/part_${_shared} --target part OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${WORK}/part_${_shared}/part COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# Without debug information, with licences, and of the size that one expects: below 16 MB, of which the paths of the build are a few KB. 2.3
# MB of these are kernels for products of matrices in faer, 0.3 MB of them in single precision, in which factors are computed; 2.3 MB came
# with the writer of STEP, whose crate has code for each of the entities of AP242, of which our files have a few dozen; 2.6 MB came with
# matching, whose Newton steps solve systems without symmetry by faer's sparse LU.
file(GLOB _shared ${_prefix}/${LIBDIR}/libricci.so.*.*.*)
file(SIZE ${_shared} _shared_size)
file(SIZE ${_prefix}/${LIBDIR}/libricci.a _static_size)
message(STATUS "shared library ${_shared_size} bytes, static library ${_static_size} bytes")
if(RELEASE AND (_shared_size GREATER 16000000 OR _static_size GREATER 36000000))
  message(FATAL_ERROR "the installed libraries are too large")
endif()
foreach(_licence LICENSE-MIT LICENSE-APACHE THIRD-PARTY.txt README.md docs/c-conventions.md)
  if(NOT EXISTS ${_prefix}/share/doc/ricci/${_licence})
    message(FATAL_ERROR "${_licence} was not installed")
  endif()
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
# The static library, as pkg-config --static has it.
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs --static ricci OUTPUT_VARIABLE _static
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "-lricci" "-l:libricci.a" _static "${_static}")
separate_arguments(_static)
execute_process(COMMAND ${CC} ${SOURCE}/main.c -o ${WORK}/static_with_pkg_config ${_static} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/static_with_pkg_config COMMAND_ERROR_IS_FATAL ANY)
# And without any shared library, where the system has its own as archives.
execute_process(COMMAND ${CC} -static -Wl,--gc-sections ${SOURCE}/main.c -o ${WORK}/all_static ${_static} RESULT_VARIABLE _result ERROR_VARIABLE _why)
if(_result EQUAL 0)
  execute_process(COMMAND ${WORK}/all_static COMMAND_ERROR_IS_FATAL ANY)
elseif(_why MATCHES "cannot find -lc|cannot find -lm")
  message(STATUS "the C library is not installed as an archive; the test of -static is left out")
else()
  message(FATAL_ERROR "${_why}")
endif()

find_path(_eigen Eigen/Core PATH_SUFFIXES eigen3)
if(_eigen)
  execute_process(COMMAND ${CXX} -std=c++14 -isystem ${_eigen} ${EXAMPLES}/eigen.cpp -o ${WORK}/eigen ${_flags}
    -Wl,-rpath,${_prefix}/${LIBDIR} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${WORK}/eigen ${MESH} COMMAND_ERROR_IS_FATAL ANY)
endif()
find_path(_openmesh OpenMesh/Core/IO/MeshIO.hh)
find_library(_openmesh_core OpenMeshCore)
if(_openmesh AND _openmesh_core)
  execute_process(COMMAND ${CXX} -std=c++14 ${EXAMPLES}/openmesh.cpp -o ${WORK}/openmesh ${_flags} ${_openmesh_core}
    -Wl,-rpath,${_prefix}/${LIBDIR} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${WORK}/openmesh ${MESH} COMMAND_ERROR_IS_FATAL ANY)
endif()
# All adapters with the installed headers.
find_path(_cgal CGAL/Surface_mesh.h)
if(_cgal AND _openmesh AND _openmesh_core AND _eigen)
  execute_process(COMMAND ${CXX} -std=c++17 -isystem ${_eigen} ${SOURCE}/../openmesh/adapters.cpp -o ${WORK}/adapters ${_flags}
    ${_openmesh_core} -lmpfr -lgmp -Wl,-rpath,${_prefix}/${LIBDIR} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${WORK}/adapters COMMAND_ERROR_IS_FATAL ANY)
else()
  message(STATUS "CGAL, OpenMesh or Eigen is not installed; their adapters are not tried from the installed package")
endif()
set(ENV{PKG_CONFIG_PATH} "")
execute_process(COMMAND ${PKG_CONFIG} --exists ricci RESULT_VARIABLE _result)
if(_result EQUAL 0)
  message(FATAL_ERROR "pkg-config finds a ricci that was not installed here")
endif()
