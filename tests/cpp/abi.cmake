# The ABI that the headers in HEADERS promise is that of the committed BASELINE: functions, arguments, and the layout of every struct.
#
# The headers are compiled, each function with an empty body, into a library with full debug information; capi/tests/header.rs holds them
# against the library's source, and the test `exports` against its symbols. RICCI_BLESS=1 writes the baseline anew.
set(_stub "")
foreach(_name ricci uniformize circles harmonic structure match seamless quads spline bicubic quad_spline repair shapes)
  string(APPEND _stub "#include <ricci/${_name}.h>\n")
  file(READ ${HEADERS}/${_name}.h _header)
  string(REGEX REPLACE "/\\*[^*]*\\*+([^/*][^*]*\\*+)*/" "" _header "${_header}")
  string(REPLACE ";" "@" _header "${_header}")
  string(REGEX MATCHALL "\nRICCI_API[^@]+@" _functions "${_header}")
  foreach(_function ${_functions})
    string(REPLACE "@" " {\n}\n" _function "${_function}")
    string(REGEX REPLACE "RICCI_API(_VOID)? " "" _function "${_function}")
    string(APPEND _stub "${_function}")
  endforeach()
endforeach()
file(MAKE_DIRECTORY ${WORK})
file(WRITE ${WORK}/abi.c "${_stub}")
get_filename_component(_include ${HEADERS} DIRECTORY)
execute_process(COMMAND ${CC} -g -w -fPIC -shared -ffile-prefix-map=${WORK}/= -I${_include} ${WORK}/abi.c -o ${WORK}/libabi.so COMMAND_ERROR_IS_FATAL ANY)

if(DEFINED ENV{RICCI_BLESS})
  execute_process(COMMAND ${ABIDW} --no-show-locs --no-corpus-path --no-comp-dir-path --no-elf-needed --out-file ${BASELINE}
    ${WORK}/libabi.so COMMAND_ERROR_IS_FATAL ANY)
endif()
execute_process(COMMAND ${ABIDIFF} --no-added-syms --no-show-locs ${BASELINE} ${WORK}/libabi.so
  OUTPUT_VARIABLE _changes RESULT_VARIABLE _changed)
if(NOT _changed EQUAL 0)
  message(FATAL_ERROR "the ABI is not that of ${BASELINE}: raise the minor version, and write it anew with RICCI_BLESS=1\n${_changes}")
endif()
