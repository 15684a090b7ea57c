# Makes ARCHIVE one object with what the functions of the C face need: without debug information, sections that nobody uses and the
# compiler's own code, and with no other names than those that SHARED exports.
execute_process(COMMAND ${NM} -D --defined-only ${SHARED} OUTPUT_VARIABLE _nm COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "ricci_[a-z0-9_]+" _functions "${_nm}")
list(REMOVE_DUPLICATES _functions)
list(TRANSFORM _functions PREPEND "-u" OUTPUT_VARIABLE _roots)
list(JOIN _functions "\n" _names)
file(WRITE ${ARCHIVE}.names "${_names}\n")
execute_process(COMMAND ${LD} -r --gc-sections ${_roots} -o ${ARCHIVE}.o ${ARCHIVE} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${OBJCOPY} --strip-debug --remove-section=.llvmbc --remove-section=.llvmcmd
  --keep-global-symbols=${ARCHIVE}.names ${ARCHIVE}.o COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE ${ARCHIVE})
execute_process(COMMAND ${AR} rcs ${ARCHIVE} ${ARCHIVE}.o COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE ${ARCHIVE}.o ${ARCHIVE}.names)
