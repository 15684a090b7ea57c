# The ABI that the headers in HEADERS promise is that of the committed BASELINE: functions, arguments, and the layout of every struct.
#
# The headers are compiled, each function with an empty body, into a library with full debug information; capi/tests/header.rs holds them
# against the library's source, and the test `exports` against its symbols. RICCI_BLESS=1 writes the baseline anew.
set(_stub "")
set(_n 0)
file(GLOB _files ${HEADERS}/*.h)
foreach(_file ${_files})
  get_filename_component(_name ${_file} NAME)
  string(APPEND _stub "#include <ricci/${_name}>\n")
  file(READ ${_file} _header)
  string(REGEX REPLACE "/\\*[^*]*\\*+([^/*][^*]*\\*+)*/" "" _header "${_header}")
  string(REPLACE ";" "@" _header "${_header}")
  string(REGEX MATCHALL "\nRICCI_API[^@]+@" _functions "${_header}")
  foreach(_function ${_functions})
    string(REPLACE "@" " {\n}\n" _function "${_function}")
    string(REGEX REPLACE "RICCI_API(_VOID)? " "" _function "${_function}")
    string(APPEND _stub "${_function}")
    math(EXPR _n "${_n} + 1")
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
# abidiff is told that functions may be added; the baseline has those of today all the same.
file(STRINGS ${BASELINE} _symbols REGEX "<elf-symbol name=")
list(LENGTH _symbols _known)
if(NOT _known EQUAL _n)
  message(FATAL_ERROR "${BASELINE} has ${_known} functions, the headers have ${_n}: write it anew with RICCI_BLESS=1")
endif()
execute_process(COMMAND ${ABIDIFF} --no-added-syms --no-show-locs ${BASELINE} ${WORK}/libabi.so
  OUTPUT_VARIABLE _changes RESULT_VARIABLE _changed)
if(NOT _changed EQUAL 0)
  message(FATAL_ERROR "the ABI is not that of ${BASELINE}: raise the minor version, and write it anew with RICCI_BLESS=1\n${_changes}")
endif()
