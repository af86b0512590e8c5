# cmake -DPREFIX=<installed Weft> -DTHREADS=<oneTBB|std::thread> -DLIBDIR=lib -DSAMPLE=<README.md's program> <variables of bits.cmake> -P shared.cmake
# A project that fetches Weft as shared libraries (fetch_content), and a program outside that finds what it has installed.
include("${CMAKE_CURRENT_LIST_DIR}/bits.cmake")
foreach(bridge IN ITEMS bridge bridge_float64)
  build_bits("${FOLDER}/installed_${bridge}" "${PREFIX}" ${bridge})
  read_bits("${FOLDER}/installed_${bridge}/bits" "${THREADS}" expected_${bridge})
endforeach()

run("${CMAKE_COMMAND}" -S "${SOURCE}/tests/install/fetch_content" -B "${FOLDER}/build" ${common} ${in_units} "-DWEFT_SOURCE_DIR=${SOURCE}"
    "-DFETCHCONTENT_BASE_DIR=${FOLDER}/fetched" -DFETCHCONTENT_FULLY_DISCONNECTED=ON)
run("${CMAKE_COMMAND}" --build "${FOLDER}/build")
foreach(bridge IN ITEMS bridge bridge_float64)
  read_bits("${FOLDER}/build/bits_${bridge}" "${THREADS}" bits)
  expect_equal_bits("fetched, shared, ${bridge}" "${bits}" "${expected_${bridge}}")
endforeach()

# Installed and then moved. What a shared library is linked with is its own affair: a program need not find oneTBB.
set(prefix "${FOLDER}/prefix")
file(REMOVE_RECURSE "${prefix}" "${prefix}-before-the-move")
run("${CMAKE_COMMAND}" --install "${FOLDER}/build" --prefix "${prefix}-before-the-move")
file(RENAME "${prefix}-before-the-move" "${prefix}")
foreach(bridge IN ITEMS bridge bridge_float64)
  build_bits("${FOLDER}/${bridge}" "${prefix}" ${bridge} ${no_oneTBB})
  read_bits("${FOLDER}/${bridge}/bits" "${THREADS}" bits)
  expect_equal_bits("installed, shared, ${bridge}" "${bits}" "${expected_${bridge}}")
  # Both find one core, beside them.
  file(GET_RUNTIME_DEPENDENCIES LIBRARIES "${prefix}/${LIBDIR}/libweft_${bridge}.so" RESOLVED_DEPENDENCIES_VAR needed)
  set(core "${needed}")
  list(FILTER core INCLUDE REGEX "libweft_core")
  if(NOT core MATCHES "^${prefix}/${LIBDIR}/libweft_core.so[.0-9]*$")
    message(FATAL_ERROR "libweft_${bridge}.so finds '${core}', expected one libweft_core beside it")
  endif()
endforeach()

# pkg-config, which says nothing of where programs look for libraries.
set(ENV{LD_LIBRARY_PATH} "${prefix}/${LIBDIR}:$ENV{LD_LIBRARY_PATH}")
set(PREFIX "${prefix}")
set(library "${prefix}/${LIBDIR}/libweft_bridge.so")
set(FOLDER "${FOLDER}/pkg_config")
include("${CMAKE_CURRENT_LIST_DIR}/pkg_config.cmake")

# Nothing of Eigen, Bullet and the standard library is shown, in whose place that of the program could be taken.
execute_process(COMMAND nm --dynamic --defined-only --demangle "${library}" OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[0-9a-f]+ [A-Za-z] [^\n]*" symbols "${symbols}")
if(NOT symbols MATCHES "weft::bridge::")
  message(FATAL_ERROR "${library} shows nothing of Weft")
endif()
list(FILTER symbols EXCLUDE REGEX "weft::")
if(symbols)
  list(GET symbols 0 symbol)
  message(FATAL_ERROR "${library} shows '${symbol}', expected names of weft:: alone")
endif()
