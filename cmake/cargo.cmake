# Drives cargo and gives its libraries their names: targets ricci::ricci_shared and ricci::ricci_static, and ricci::ricci, which is
# the one that BUILD_SHARED_LIBS asks for (default: shared).
#
# RICCI_CARGO_PROFILE     cargo profile: release (default) or dev
# RICCI_CARGO_TARGET_DIR  where cargo builds: $CARGO_TARGET_DIR or target/ by default
# RICCI_CARGO_TARGET      the Rust target; default when cross-compiling: <processor>-unknown-linux-gnu, else the host
# RICCI_CARGO_OFFLINE     ON: nothing is downloaded, as from the tarball of cmake/tarball.cmake

if(WIN32)
  message(FATAL_ERROR "ricci: the C face is built on Linux and macOS only")
endif()

find_program(CARGO cargo HINTS $ENV{CARGO_HOME}/bin $ENV{HOME}/.cargo/bin)
if(NOT CARGO)
  message(FATAL_ERROR "ricci: building needs a Rust toolchain (https://rustup.rs); "
                      "using an installed ricci does not")
endif()

set(RICCI_CARGO_PROFILE release CACHE STRING "cargo profile: release or dev")
if(DEFINED ENV{CARGO_TARGET_DIR})
  set(_target_dir $ENV{CARGO_TARGET_DIR})
else()
  set(_target_dir ${PROJECT_SOURCE_DIR}/target)
endif()
set(RICCI_CARGO_TARGET_DIR ${_target_dir} CACHE PATH "where cargo builds")
set(_profile_dir ${RICCI_CARGO_PROFILE})
if(RICCI_CARGO_PROFILE STREQUAL "dev")
  set(_profile_dir debug)
endif()

# What CMake compiles for is what cargo builds for.
set(_target "")
if(CMAKE_CROSSCOMPILING)
  if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT RICCI_CARGO_TARGET)
    message(FATAL_ERROR "ricci: name the Rust target for ${CMAKE_SYSTEM_NAME} in RICCI_CARGO_TARGET")
  endif()
  set(_target ${CMAKE_SYSTEM_PROCESSOR}-unknown-linux-gnu)
endif()
set(RICCI_CARGO_TARGET "${_target}" CACHE STRING "the Rust target; empty: the host")
option(RICCI_CARGO_OFFLINE "build without the network" OFF)
set(_cargo_args)
set(_cargo_env)
if(RICCI_CARGO_TARGET)
  list(APPEND _cargo_args --target ${RICCI_CARGO_TARGET})
  string(APPEND _profile_dir_prefix ${RICCI_CARGO_TARGET}/)
  string(TOUPPER "CARGO_TARGET_${RICCI_CARGO_TARGET}_LINKER" _linker)
  string(REPLACE "-" "_" _linker ${_linker})
  set(_cargo_env ${CMAKE_COMMAND} -E env ${_linker}=${CMAKE_C_COMPILER})
endif()
if(RICCI_CARGO_OFFLINE)
  list(APPEND _cargo_args --offline)
endif()
set(_built_dir ${RICCI_CARGO_TARGET_DIR}/${_profile_dir_prefix}${_profile_dir})

# Names in the build tree are those of an installation.
# Until 1.0 a new minor version is a new ABI (capi/build.rs says the same to the linker).
set(_soversion ${PROJECT_VERSION_MAJOR})
if(_soversion EQUAL 0)
  set(_soversion 0.${PROJECT_VERSION_MINOR})
endif()
if(APPLE)
  set(_built libricci_c.dylib)
  set(RICCI_SHARED libricci.${PROJECT_VERSION}.dylib)
  set(RICCI_SHARED_LINKS libricci.${_soversion}.dylib libricci.dylib)
else()
  set(_built libricci_c.so)
  set(RICCI_SHARED libricci.so.${PROJECT_VERSION})
  set(RICCI_SHARED_LINKS libricci.so.${_soversion} libricci.so)
endif()
set(RICCI_STATIC libricci.a)
set(RICCI_LIB_DIR ${PROJECT_BINARY_DIR}/lib)

# What a program that links the static library needs besides: `rustc --print native-static-libs`.
if(APPLE)
  set(RICCI_SYSTEM_LIBS m)
else()
  set(RICCI_SYSTEM_LIBS gcc_s pthread m dl)
endif()

set(_links)
foreach(_link ${RICCI_SHARED_LINKS})
  list(APPEND _links COMMAND ${CMAKE_COMMAND} -E create_symlink ${RICCI_SHARED} ${RICCI_LIB_DIR}/${_link})
endforeach()
add_custom_target(ricci_cargo ALL
  COMMAND ${_cargo_env} ${CARGO} build --locked --package ricci-capi --lib --profile ${RICCI_CARGO_PROFILE}
          --target-dir ${RICCI_CARGO_TARGET_DIR} ${_cargo_args}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${RICCI_LIB_DIR}
  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${_built_dir}/${_built} ${RICCI_LIB_DIR}/${RICCI_SHARED}
  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${_built_dir}/libricci_c.a ${RICCI_LIB_DIR}/${RICCI_STATIC}
  ${_links}
  BYPRODUCTS ${RICCI_LIB_DIR}/${RICCI_SHARED} ${RICCI_LIB_DIR}/${RICCI_STATIC}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  COMMENT "cargo build (${RICCI_CARGO_PROFILE})"
  USES_TERMINAL VERBATIM)

add_library(ricci::ricci_shared SHARED IMPORTED GLOBAL)
set_target_properties(ricci::ricci_shared PROPERTIES
  IMPORTED_LOCATION ${RICCI_LIB_DIR}/${RICCI_SHARED}
  INTERFACE_INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/include)
list(GET RICCI_SHARED_LINKS 0 RICCI_SONAME)
if(APPLE)
  string(PREPEND RICCI_SONAME @rpath/)
endif()
set_target_properties(ricci::ricci_shared PROPERTIES IMPORTED_SONAME ${RICCI_SONAME})
add_dependencies(ricci::ricci_shared ricci_cargo)

add_library(ricci::ricci_static STATIC IMPORTED GLOBAL)
set_target_properties(ricci::ricci_static PROPERTIES
  IMPORTED_LOCATION ${RICCI_LIB_DIR}/${RICCI_STATIC}
  INTERFACE_INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/include
  INTERFACE_LINK_LIBRARIES "${RICCI_SYSTEM_LIBS}")
add_dependencies(ricci::ricci_static ricci_cargo)

if(DEFINED BUILD_SHARED_LIBS AND NOT BUILD_SHARED_LIBS)
  add_library(ricci::ricci ALIAS ricci::ricci_static)
else()
  add_library(ricci::ricci ALIAS ricci::ricci_shared)
endif()
