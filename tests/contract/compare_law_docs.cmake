# cmake -DPROGRAM=<weft_law_docs> -DPAGE=<docs/force_laws.md> -P compare_law_docs.cmake
execute_process(COMMAND "${PROGRAM}" OUTPUT_VARIABLE generated COMMAND_ERROR_IS_FATAL ANY)
set(stored "")
if(EXISTS "${PAGE}")
  file(READ "${PAGE}" stored)
endif()
if(NOT generated STREQUAL stored)
  message(FATAL_ERROR "${PAGE} differs from the registry. To write it anew:\n  ${PROGRAM} > ${PAGE}")
endif()
