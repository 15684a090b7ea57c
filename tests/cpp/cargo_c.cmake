# `cargo cinstall` with the metadata of capi/Cargo.toml installs a library that pkg-config finds.
find_program(CARGO_CINSTALL cargo-cinstall HINTS $ENV{CARGO_HOME}/bin $ENV{HOME}/.cargo/bin)
find_program(PKG_CONFIG pkg-config)
if(NOT CARGO_CINSTALL OR NOT PKG_CONFIG)
  message(STATUS "skipped: cargo-c or pkg-config is not installed")
  return()
endif()
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CARGO_CINSTALL} cinstall --package ricci-capi --prefix ${WORK}/prefix --libdir lib --target-dir ${WORK}/target
  WORKING_DIRECTORY ${ROOT} COMMAND_ERROR_IS_FATAL ANY)
set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/lib/pkgconfig)
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs ricci OUTPUT_VARIABLE _flags OUTPUT_STRIP_TRAILING_WHITESPACE
  COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(_flags)
execute_process(COMMAND ${CC} ${SOURCE}/main.c -o ${WORK}/main ${_flags} -Wl,-rpath,${WORK}/prefix/lib COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/main COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${WORK}/target)
