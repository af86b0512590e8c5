# cmake -DPREFIX=<installed Weft> -DTHREADS=<oneTBB|std::thread> -DSAMPLE=<README.md's program> <variables of bits.cmake> -P without_tbb.cmake
# Weft built, installed, found and linked where oneTBB is not found. Nothing of it asks for oneTBB, and it has the same bits.
include("${CMAKE_CURRENT_LIST_DIR}/bits.cmake")
build_bits("${FOLDER}/installed" "${PREFIX}" bridge)
read_bits("${FOLDER}/installed/bits" "${THREADS}" expected)

run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${FOLDER}/build" ${common} ${in_units} ${no_oneTBB} -DWEFT_WITH_FLOAT64=OFF -DWEFT_BUILD_APPS=OFF
    -DWEFT_BUILD_TESTS=OFF -DWEFT_WITH_IMPORT=OFF -DWEFT_PYTHON=OFF)
run("${CMAKE_COMMAND}" --build "${FOLDER}/build")
set(prefix "${FOLDER}/prefix")
file(REMOVE_RECURSE "${prefix}")
run("${CMAKE_COMMAND}" --install "${FOLDER}/build" --prefix "${prefix}")

file(GLOB_RECURSE texts "${prefix}/*.hpp" "${prefix}/*.pc" "${prefix}/*/weft_*.cmake")
foreach(text IN LISTS texts)
  file(STRINGS "${text}" lines REGEX "tbb/|TBB::|Requires:.* tbb" LIMIT_COUNT 1)
  if(lines)
    message(FATAL_ERROR "${text} asks for oneTBB: ${lines}")
  endif()
endforeach()

build_bits("${FOLDER}/own" "${prefix}" bridge ${no_oneTBB})
read_bits("${FOLDER}/own/bits" std::thread bits)
expect_equal_bits("without oneTBB" "${bits}" "${expected}")
set(PREFIX "${prefix}")
set(FOLDER "${FOLDER}/pkg_config")
include("${CMAKE_CURRENT_LIST_DIR}/pkg_config.cmake")
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES "${FOLDER}/sample" RESOLVED_DEPENDENCIES_VAR needed UNRESOLVED_DEPENDENCIES_VAR not_found)
if("${needed};${not_found}" MATCHES "libtbb")
  message(FATAL_ERROR "the sample needs ${CMAKE_MATCH_0}")
endif()
