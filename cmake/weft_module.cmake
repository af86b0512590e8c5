# weft_add_module(<name> PATH <folder under the source root> SOURCES ... HEADERS ... [PUBLIC ...] [PRIVATE ...]
#                 [HIDE <child folders that belong to another module>] [NO_INSTALL] [NO_PRECOMPILE])
#
# One module = one library target weft_<name>, alias weft::<name>; static, or shared with BUILD_SHARED_LIBS if it is installed. Each module has an include root of its own
# (build/include/<name>/weft/<path> -> source), so a file can include only the modules its target links: the
# arrows of the architecture are enforced by the compiler, not by a convention.

if(WIN32 AND BUILD_SHARED_LIBS)
  message(FATAL_ERROR "BUILD_SHARED_LIBS = ${BUILD_SHARED_LIBS}, expected OFF: on Windows Weft's libraries are static")
endif()

# GCC does not align the stack of Windows to more than 16 bytes, and yet moves vectors of 32 and 64 bytes to and from it as if it did (GCC bug
# 54412): what is compiled for AVX crashes. Debian's MinGW is mended, others are not; the assembler knows a move that asks for no alignment.
if(MINGW AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-Wa,-muse-unaligned-vector-move WEFT_HAS_UNALIGNED_VECTOR_MOVES)
  if(NOT WEFT_HAS_UNALIGNED_VECTOR_MOVES)
    message(FATAL_ERROR "The assembler does not know -muse-unaligned-vector-move, expected binutils 2.38 or newer")
  endif()
endif()

function(weft_target_flags target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # -ffp-contract=off: the same source gives the same bits whether or not the compiler may fuse a*b+c.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(WEFT_HAS_UNALIGNED_VECTOR_MOVES)
    target_compile_options(${target} PRIVATE -Wa,-muse-unaligned-vector-move)
  endif()
  if(WEFT_WARNINGS OR WEFT_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic
      # GCC 12 sees overlapping copies in std::string's operator+ where there are none (GCC bug 105651).
      $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  else()
    target_compile_options(${target} PRIVATE -w)
  endif()
  if(CMAKE_UNITY_BUILD)
    # A unit of several sources includes them, and so GCC takes them for headers, in which an unnamed namespace is a mistake.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    # Such a unit takes GCC up to 1.7 GB, of 1.4 at its least; collecting garbage before that is a tenth of its time.
    target_compile_options(${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=2097152 --param ggc-min-expand=300>")
  endif()
  if(WEFT_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# The headers that most files of Weft and its tests begin with, read once for all modules and once for all tests. Only
# GCC's are asked for: the builds with clang keep every file honest about what it includes.
set(weft_common_headers <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <random> <span> <sstream>
                        <string> <string_view> <unordered_map> <variant> <vector> <Eigen/Geometry>)
if(WEFT_PRECOMPILE_HEADERS AND NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  message(STATUS "Weft: WEFT_PRECOMPILE_HEADERS has no effect with ${CMAKE_CXX_COMPILER_ID}")
  set(WEFT_PRECOMPILE_HEADERS OFF)
endif()

# -fpch-preprocess: so that ccache can keep what uses them. With precompiled headers GCC 12 also warns of other faces of
# its bug 105651, inside the standard library.
function(weft_precompiled_flags target)
  target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
endfunction()

# A target that carries precompiled headers for others to share: whatever else those are compiled with does not change
# what is in them. Making them takes as long as reading them four times.
function(weft_add_precompiled name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LIBRARIES;HEADERS")
  file(WRITE "${PROJECT_BINARY_DIR}/${name}.cpp" "")
  add_library(${name} OBJECT "${PROJECT_BINARY_DIR}/${name}.cpp")
  weft_target_flags(${name})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES})
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
  weft_precompiled_flags(${name})
endfunction()

function(weft_precompile_module target)
  if(WEFT_PRECOMPILE_HEADERS)
    if(NOT TARGET weft_module_headers)
      weft_add_precompiled(weft_module_headers LIBRARIES weft::core HEADERS ${weft_common_headers})
      set_target_properties(weft_module_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
    target_precompile_headers(${target} REUSE_FROM weft_module_headers)
    weft_precompiled_flags(${target})
  endif()
endfunction()

# Makes build/include/<root>/weft/<path> show the source folder, leaving out the children listed in HIDE.
function(weft_include_root root path out_variable)
  cmake_parse_arguments(PARSE_ARGV 3 arg "" "" "HIDE")
  set(base "${PROJECT_BINARY_DIR}/include/${root}")
  set(link "${base}/weft/${path}")
  if(NOT arg_HIDE)
    cmake_path(GET link PARENT_PATH parent)
    file(MAKE_DIRECTORY "${parent}")
    file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${path}" "${link}" SYMBOLIC)
  else()
    file(MAKE_DIRECTORY "${link}")
    file(GLOB children CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}/${path}" "${PROJECT_SOURCE_DIR}/${path}/*")
    foreach(child IN LISTS children)
      if(NOT child IN_LIST arg_HIDE)
        file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${path}/${child}" "${link}/${child}" SYMBOLIC)
      endif()
    endforeach()
  endif()
  set(${out_variable} "${base}" PARENT_SCOPE)
endfunction()

# What a shared library shows is Weft's own: Eigen's and the standard library's functions that are compiled into it would
# otherwise take the place of those that the program has compiled with other flags. Installed libraries find each other.
#
# weft_find_libraries(<target> <folder it is installed to, below the prefix>): the same for programs and extension modules.
function(weft_find_libraries target folder)
  if(BUILD_SHARED_LIBS AND UNIX AND NOT APPLE)
    file(RELATIVE_PATH to_libraries "/${folder}" "/${CMAKE_INSTALL_LIBDIR}")
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/${to_libraries}")
  endif()
endfunction()

function(weft_shared_library target)
  set_target_properties(${target} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    DEFINE_SYMBOL "")  # which precompiled headers would have to be made without
  if(APPLE)
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "@loader_path")
  elseif(UNIX)
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN" LINK_DEPENDS "${PROJECT_SOURCE_DIR}/cmake/weft_symbols.map")
    target_link_options(${target} PRIVATE "LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/weft_symbols.map")
  endif()
endfunction()

function(weft_add_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "NO_INSTALL;NO_PRECOMPILE" "PATH" "SOURCES;HEADERS;PUBLIC;PRIVATE;HIDE")
  set(target weft_${name})
  if(BUILD_SHARED_LIBS AND NOT arg_NO_INSTALL)
    add_library(${target} SHARED ${arg_SOURCES})
    weft_shared_library(${target})
  else()
    add_library(${target} STATIC ${arg_SOURCES})
  endif()
  add_library(weft::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  weft_target_flags(${target})
  weft_include_root(${name} ${arg_PATH} include_root HIDE ${arg_HIDE})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${include_root}>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  if(NOT arg_NO_PRECOMPILE)
    weft_precompile_module(${target})
  endif()
  set_target_properties(${target} PROPERTIES WEFT_PATH "${arg_PATH}" WEFT_HEADERS "${arg_HEADERS}")
  set_property(GLOBAL APPEND PROPERTY WEFT_MODULES ${target})
  if(NOT arg_NO_INSTALL)
    set_property(GLOBAL APPEND PROPERTY WEFT_INSTALLED_MODULES ${target})
  endif()
endfunction()

function(weft_precompile_test target)
  if(WEFT_PRECOMPILE_HEADERS)
    if(NOT TARGET weft_test_headers)
      weft_add_precompiled(weft_test_headers LIBRARIES weft::core GTest::gmock
                           HEADERS ${weft_common_headers} <gmock/gmock.h> <gtest/gtest.h>)
    endif()
    target_precompile_headers(${target} REUSE_FROM weft_test_headers)
    weft_precompiled_flags(${target})
  endif()
endfunction()

# weft_add_test(<name> SOURCES ... LIBRARIES ... [LABELS ...] [TIMEOUT s] [NOT_SANITIZED <patterns of tests>]): one GoogleTest
# executable. NOT_SANITIZED are tests that judge a long motion, minutes under a sanitizer, through code that others go through too.
function(weft_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT" "SOURCES;LIBRARIES;LABELS;DEFINITIONS;NOT_SANITIZED")
  add_executable(${name} ${arg_SOURCES})
  weft_target_flags(${name})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}")  # for "tests/support/..."
  target_compile_definitions(${name} PRIVATE WEFT_SOURCE_DIR="${PROJECT_SOURCE_DIR}" ${arg_DEFINITIONS})
  # weft::core: a test that needs no module is compiled as all others are, with the precompiled headers.
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} weft::core GTest::gmock GTest::gtest_main)
  weft_precompile_test(${name})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    math(EXPR arg_TIMEOUT "4 * ${arg_TIMEOUT}")
  endif()
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT})
  if(arg_NOT_SANITIZED AND CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    string(JOIN ":" left_out ${arg_NOT_SANITIZED})
    set_tests_properties(${name} PROPERTIES ENVIRONMENT "GTEST_FILTER=-${left_out}")
  endif()
endfunction()

# weft_add_slow_test(<name> <program> <variable=value>): a test program again, with an environment that asks for more of it.
function(weft_add_slow_test name program environment)
  add_test(NAME ${name} COMMAND ${program})
  set_tests_properties(${name} PROPERTIES LABELS slow TIMEOUT 7200 ENVIRONMENT "${environment}")
endfunction()
