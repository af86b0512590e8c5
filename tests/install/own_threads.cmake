# cmake -DPREFIX=<installed Weft> -DTHREADS=<oneTBB|std::thread> <variables of bits.cmake> -P own_threads.cmake
# The installed libraries with threads from oneTBB and with Weft's own: core alone is compiled differently. The same bits.
include("${CMAKE_CURRENT_LIST_DIR}/bits.cmake")
build_bits("${FOLDER}/installed" "${PREFIX}" bridge)
read_bits("${FOLDER}/installed/bits" "${THREADS}" expected)
run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${FOLDER}/core" ${common} -DWEFT_THREADS=STD -DWEFT_WITH_BULLET=OFF -DWEFT_BUILD_APPS=OFF
    -DWEFT_BUILD_TESTS=OFF -DWEFT_WITH_IMPORT=OFF -DWEFT_PYTHON=OFF)
run("${CMAKE_COMMAND}" --build "${FOLDER}/core" --target weft_core)
build_bits("${FOLDER}/own" "${PREFIX}" bridge "-DCORE=${FOLDER}/core/core/libweft_core.a")
read_bits("${FOLDER}/own/bits" std::thread bits)
expect_equal_bits("with Weft's own threads" "${bits}" "${expected}")
