# Drives cargo and gives its libraries their names: targets ricci::ricci_shared and ricci::ricci_static, and ricci::ricci, which is
# the one that BUILD_SHARED_LIBS asks for (default: shared).
#
# RICCI_CARGO_PROFILE     cargo profile: release (default) or dev
# RICCI_CARGO_TARGET_DIR  where cargo builds: $CARGO_TARGET_DIR or target/ by default
# RICCI_CARGO_TARGET      the Rust target; default when cross-compiling for Linux or, by MinGW, for Windows: that of CMake's processor;
#                         else the host
# RICCI_CARGO_WITH        packages that are built beside it, so that the crates of both are compiled once (tests/run: the command)
# RICCI_FEATURES          parts of the library that a build can leave out: all by default, "gltf;gifti;gzip;quads;splines;step"
# RICCI_CARGO_OFFLINE     ON: nothing is downloaded, as from the tarball of cmake/tarball.cmake

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
  if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
    set(_target ${CMAKE_SYSTEM_PROCESSOR}-unknown-linux-gnu)
  elseif(MINGW)
    set(_target ${CMAKE_SYSTEM_PROCESSOR}-pc-windows-gnu)
  elseif(NOT RICCI_CARGO_TARGET)
    message(FATAL_ERROR "ricci: name the Rust target for ${CMAKE_SYSTEM_NAME} in RICCI_CARGO_TARGET")
  endif()
endif()
set(RICCI_CARGO_TARGET "${_target}" CACHE STRING "the Rust target; empty: the host")
option(RICCI_CARGO_OFFLINE "build without the network" OFF)
set(RICCI_CARGO_WITH "" CACHE STRING "cargo packages that are built beside ricci-capi")
set(_cargo_packages --package ricci-capi --lib)
set(_all_features gltf gifti gzip quads splines step)
set(RICCI_FEATURES ${_all_features} CACHE STRING "parts of the library: gltf, gifti, gzip, quads, splines, step (with splines)")
if(NOT RICCI_FEATURES STREQUAL "${_all_features}")
  list(TRANSFORM RICCI_FEATURES PREPEND "ricci-capi/" OUTPUT_VARIABLE _features)
  list(JOIN _features "," _features)
  list(APPEND _cargo_packages --no-default-features "--features=${_features}")
endif()
if(RICCI_CARGO_WITH)
  list(TRANSFORM RICCI_CARGO_WITH PREPEND "--package=" OUTPUT_VARIABLE _cargo_with)
  list(APPEND _cargo_packages --bins ${_cargo_with})
endif()
set(_cargo_args)
# Cargo looks for rustc on the path, on which the build may have neither.
get_filename_component(_cargo_folder ${CARGO} DIRECTORY)
find_program(RUSTC rustc HINTS ${_cargo_folder} REQUIRED)
set(_cargo_env ${CMAKE_COMMAND} -E env RUSTC=${RUSTC})
if(RICCI_CARGO_TARGET)
  list(APPEND _cargo_args --target ${RICCI_CARGO_TARGET})
  string(APPEND _profile_dir_prefix ${RICCI_CARGO_TARGET}/)
  string(TOUPPER "CARGO_TARGET_${RICCI_CARGO_TARGET}_LINKER" _linker)
  string(REPLACE "-" "_" _linker ${_linker})
  list(APPEND _cargo_env ${_linker}=${CMAKE_C_COMPILER})
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
set(_built_static libricci_c.a)
set(RICCI_STATIC libricci.a)
set(_built_import)
set(RICCI_IMPORT)
set(RICCI_SHARED_LINKS)
if(WIN32)
  # The import library knows the DLL by the name that cargo gives it.
  set(_built ricci_c.dll)
  set(RICCI_SHARED ricci_c.dll)
  if(MSVC)
    set(_built_static ricci_c.lib)
    set(RICCI_STATIC ricci_static.lib)
    set(_built_import ricci_c.dll.lib)
    set(RICCI_IMPORT ricci.lib)
  else()
    set(_built_import libricci_c.dll.a)
    set(RICCI_IMPORT libricci.dll.a)
  endif()
elseif(APPLE)
  set(_built libricci_c.dylib)
  set(RICCI_SHARED libricci.${PROJECT_VERSION}.dylib)
  set(RICCI_SHARED_LINKS libricci.${_soversion}.dylib libricci.dylib)
else()
  set(_built libricci_c.so)
  set(RICCI_SHARED libricci.so.${PROJECT_VERSION})
  set(RICCI_SHARED_LINKS libricci.so.${_soversion} libricci.so)
endif()
set(RICCI_LIB_DIR ${PROJECT_BINARY_DIR}/lib)

# What a program that links the static library needs besides: `rustc --print native-static-libs`.
if(WIN32)
  set(RICCI_SYSTEM_LIBS kernel32 ntdll userenv ws2_32 dbghelp)
elseif(APPLE)
  set(RICCI_SYSTEM_LIBS m)
else()
  # The unwinder is the compiler's: libgcc_s, or libgcc_eh where the program is linked with -static.
  set(RICCI_SYSTEM_LIBS pthread m dl)
endif()
# Functions of the static library that a program does not call are left out of it.
set(RICCI_STATIC_LINK_OPTIONS)
if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
  set(RICCI_STATIC_LINK_OPTIONS LINKER:--gc-sections)
endif()

set(_built_files ${_built} ${_built_static} ${_built_import})
set(_files ${RICCI_SHARED} ${RICCI_STATIC} ${RICCI_IMPORT})
list(TRANSFORM _files PREPEND ${RICCI_LIB_DIR}/)
set(_copies)
foreach(_from _to IN ZIP_LISTS _built_files _files)
  list(APPEND _copies COMMAND ${CMAKE_COMMAND} -E copy_if_different ${_built_dir}/${_from} ${_to})
endforeach()
foreach(_link ${RICCI_SHARED_LINKS})
  list(APPEND _copies COMMAND ${CMAKE_COMMAND} -E create_symlink ${RICCI_SHARED} ${RICCI_LIB_DIR}/${_link})
endforeach()
add_custom_target(ricci_cargo ALL
  COMMAND ${_cargo_env} ${CARGO} build --locked ${_cargo_packages} --profile ${RICCI_CARGO_PROFILE}
          --target-dir ${RICCI_CARGO_TARGET_DIR} ${_cargo_args}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${RICCI_LIB_DIR}
  ${_copies}
  BYPRODUCTS ${_files}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  COMMENT "cargo build (${RICCI_CARGO_PROFILE})"
  USES_TERMINAL VERBATIM)

add_library(ricci::ricci_shared SHARED IMPORTED GLOBAL)
set_target_properties(ricci::ricci_shared PROPERTIES
  IMPORTED_LOCATION ${RICCI_LIB_DIR}/${RICCI_SHARED}
  INTERFACE_INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/include)
set(RICCI_SONAME)
if(WIN32)
  set_target_properties(ricci::ricci_shared PROPERTIES IMPORTED_IMPLIB ${RICCI_LIB_DIR}/${RICCI_IMPORT})
else()
  list(GET RICCI_SHARED_LINKS 0 RICCI_SONAME)
  if(APPLE)
    string(PREPEND RICCI_SONAME @rpath/)
  endif()
  set_target_properties(ricci::ricci_shared PROPERTIES IMPORTED_SONAME ${RICCI_SONAME})
endif()
add_dependencies(ricci::ricci_shared ricci_cargo)

add_library(ricci::ricci_static STATIC IMPORTED GLOBAL)
set_target_properties(ricci::ricci_static PROPERTIES
  IMPORTED_LOCATION ${RICCI_LIB_DIR}/${RICCI_STATIC}
  INTERFACE_INCLUDE_DIRECTORIES ${PROJECT_SOURCE_DIR}/include
  INTERFACE_COMPILE_DEFINITIONS RICCI_STATIC
  INTERFACE_LINK_OPTIONS "${RICCI_STATIC_LINK_OPTIONS}"
  INTERFACE_LINK_LIBRARIES "${RICCI_SYSTEM_LIBS}")
add_dependencies(ricci::ricci_static ricci_cargo)

if(DEFINED BUILD_SHARED_LIBS AND NOT BUILD_SHARED_LIBS)
  add_library(ricci::ricci ALIAS ricci::ricci_static)
else()
  add_library(ricci::ricci ALIAS ricci::ricci_shared)
endif()
