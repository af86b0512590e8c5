# Functions for the scripts beside this one, which are run with cmake -P and have these variables: SOURCE, FOLDER, GENERATOR, MAKE,
# COMPILER, LAUNCHER, BUILD_TYPE, FLAGS.
set(common -G "${GENERATOR}" "-DCMAKE_MAKE_PROGRAM=${MAKE}" "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
           "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
# Half the time of a build of each source alone.
set(in_units -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=30 -DWEFT_PRECOMPILE_HEADERS=ON)
set(no_oneTBB -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON)

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN} ends with ${code}: ${output}")
  endif()
endfunction()

# What the program prints, into the variable result; its threads must come from the given library.
function(read_bits program library result)
  execute_process(COMMAND "${program}" OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "threads from ${library}[^\n]*\nhash ([0-9a-f]+)\n")
    message(FATAL_ERROR "${program} prints '${output}', expected threads from ${library}, and a hash")
  endif()
  set(${result} "${CMAKE_MATCH_1}" PARENT_SCOPE)
endfunction()

function(expect_equal_bits name bits expected)
  if(NOT bits STREQUAL expected)
    message(FATAL_ERROR "${name}: hash ${bits}, expected ${expected}")
  endif()
  message("${name}: hash ${bits}")
endfunction()

# build_bits(<folder> <prefix of Weft> <component> <options>...): makes <folder>/bits.
function(build_bits folder prefix component)
  run("${CMAKE_COMMAND}" -S "${SOURCE}/tests/install/bits" -B "${folder}" ${common} "-DCMAKE_PREFIX_PATH=${prefix}" "-DCOMPONENT=${component}" ${ARGN})
  run("${CMAKE_COMMAND}" --build "${folder}")
endfunction()
