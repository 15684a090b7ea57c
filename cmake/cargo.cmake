# Drives cargo and gives its libraries their names: targets ricci::ricci (shared) and ricci::ricci_static.
#
# RICCI_CARGO_PROFILE     cargo profile: release (default) or dev
# RICCI_CARGO_TARGET_DIR  where cargo builds: $CARGO_TARGET_DIR or target/ by default

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
  COMMAND ${CARGO} build --locked --package ricci-capi --lib --profile ${RICCI_CARGO_PROFILE}
          --target-dir ${RICCI_CARGO_TARGET_DIR}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${RICCI_LIB_DIR}
  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${RICCI_CARGO_TARGET_DIR}/${_profile_dir}/${_built}
          ${RICCI_LIB_DIR}/${RICCI_SHARED}
  COMMAND ${CMAKE_COMMAND} -E copy_if_different ${RICCI_CARGO_TARGET_DIR}/${_profile_dir}/libricci_c.a
          ${RICCI_LIB_DIR}/${RICCI_STATIC}
  ${_links}
  BYPRODUCTS ${RICCI_LIB_DIR}/${RICCI_SHARED} ${RICCI_LIB_DIR}/${RICCI_STATIC}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  COMMENT "cargo build (${RICCI_CARGO_PROFILE})"
  USES_TERMINAL VERBATIM)

add_library(ricci::ricci SHARED IMPORTED GLOBAL)
set_target_properties(ricci::ricci PROPERTIES
  IMPORTED_LOCATION ${RICCI_LIB_DIR}/${RICCI_SHARED}
  INTERFACE_INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/include)
list(GET RICCI_SHARED_LINKS 0 RICCI_SONAME)
if(APPLE)
  string(PREPEND RICCI_SONAME @rpath/)
endif()
set_target_properties(ricci::ricci PROPERTIES IMPORTED_SONAME ${RICCI_SONAME})
add_dependencies(ricci::ricci ricci_cargo)

add_library(ricci::ricci_static STATIC IMPORTED GLOBAL)
set_target_properties(ricci::ricci_static PROPERTIES
  IMPORTED_LOCATION ${RICCI_LIB_DIR}/${RICCI_STATIC}
  INTERFACE_INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/include
  INTERFACE_LINK_LIBRARIES "${RICCI_SYSTEM_LIBS}")
add_dependencies(ricci::ricci_static ricci_cargo)
