# cmake -DPREFIX=<installed Weft> -DLIBDIR=lib -DCOMPILER=<c++> -DFLAGS=... -DSAMPLE=<README.md's program> -DFOLDER=<new folder> -P pkg_config.cmake
# Builds a program without CMake, by what pkg-config says of the package weft, and runs it.
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
execute_process(
  COMMAND sh -c "PKG_CONFIG_PATH='${PREFIX}/${LIBDIR}/pkgconfig' && export PKG_CONFIG_PATH && '${COMPILER}' -std=c++20 -O1 ${FLAGS} '${SAMPLE}' $(pkg-config --cflags --libs weft) -o sample"
  WORKING_DIRECTORY "${FOLDER}" COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${FOLDER}/sample" OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "hangs 1.00 m below its corners")
  message(FATAL_ERROR "${output}")
endif()
