# cmake -DBUILD=<build folder> -DPREFIX=<folder> -P install_prefix.cmake
# Installs and then moves the result: a package that remembers its first place does not survive that.
file(REMOVE_RECURSE "${PREFIX}" "${PREFIX}-before-the-move")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${PREFIX}-before-the-move"
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME "${PREFIX}-before-the-move" "${PREFIX}")

# No installed file may name the tree it was built from.
file(GLOB_RECURSE package_files "${PREFIX}/*.cmake")
foreach(file IN LISTS package_files)
  file(READ "${file}" text)
  foreach(folder IN ITEMS "${BUILD}" "${SOURCE}" "${PREFIX}-before-the-move")
    string(FIND "${text}" "${folder}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${file} names ${folder}")
    endif()
  endforeach()
endforeach()
