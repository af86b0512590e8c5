# cmake -DAIM=use|configure -DPRECISION=float32|float64 ... -P one_precision.cmake
# A machine that has Bullet in one precision alone: a folder with links to the headers and to its libraries, and nothing else
# is looked at.
set(suffix "")
if(PRECISION STREQUAL "float64")
  set(suffix "-float64")
endif()
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}/machine/include" "${FOLDER}/machine/lib")
file(CREATE_LINK "${BULLET_HEADERS}" "${FOLDER}/machine/include/bullet" SYMBOLIC)
cmake_path(GET BULLET_LIBRARY PARENT_PATH libraries)
foreach(library IN ITEMS BulletSoftBody BulletDynamics BulletCollision LinearMath)
  file(CREATE_LINK "${libraries}/lib${library}${suffix}.so" "${FOLDER}/machine/lib/lib${library}${suffix}.so" SYMBOLIC)
endforeach()

# configure(<source> <expected result: well|ill> <pattern> <options>...): what CMake says has to match.
function(configure source result pattern)
  execute_process(COMMAND "${CMAKE_COMMAND}" -S "${source}" -B "${FOLDER}/build" -G "${GENERATOR}" "-DCMAKE_MAKE_PROGRAM=${MAKE}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}"
    "-DCMAKE_PREFIX_PATH=${FOLDER}/machine" -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF
    -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF "-DEigen3_DIR=${Eigen3_DIR}" "-DTBB_DIR=${TBB_DIR}" ${ARGN}
    OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE code)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(NOT output MATCHES "${pattern}" OR (code EQUAL 0 AND NOT result STREQUAL "well") OR
     (NOT code EQUAL 0 AND result STREQUAL "well"))
    message(FATAL_ERROR "CMake ended with ${code}, expected that it ends ${result} and says '${pattern}'; it says: ${output}")
  endif()
endfunction()

if(AIM STREQUAL "use")
  configure("${SOURCE}/tests/install/consumer" well "Build files have been written" "-Dweft_DIR=${PACKAGE}"
            "-DCOMPONENTS=${COMPONENT}")
  execute_process(COMMAND "${CMAKE_COMMAND}" --build "${FOLDER}/build" COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
  execute_process(COMMAND "${FOLDER}/build/consumer" COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE_RECURSE "${FOLDER}/build")
  configure("${SOURCE}/tests/install/consumer" ill "component ${ABSENT} needs Bullet in .*not found: lib" "-Dweft_DIR=${PACKAGE}"
            "-DCOMPONENTS=${ABSENT}")
else()
  configure("${SOURCE}" well "Weft: no ${ABSENT}, for Bullet's .*Build files have been written" -DWEFT_BUILD_APPS=OFF -DWEFT_BUILD_TESTS=OFF
            -DWEFT_WITH_IMPORT=OFF)
  # The bridge of the one precision is among what would be built.
  execute_process(COMMAND "${CMAKE_COMMAND}" --build "${FOLDER}/build" --target help OUTPUT_VARIABLE targets COMMAND_ERROR_IS_FATAL ANY)
  if(NOT targets MATCHES "weft_${COMPONENT}[^_]" OR targets MATCHES "weft_${ABSENT}[^_]")
    message(FATAL_ERROR "expected the target weft_${COMPONENT} and no weft_${ABSENT}; there are: ${targets}")
  endif()
endif()
