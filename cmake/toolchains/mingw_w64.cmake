# Windows programs for x86-64, made on Debian by MinGW (package g++-mingw-w64-x86-64-posix): -DCMAKE_TOOLCHAIN_FILE=<this file>.
#
# The compiler of the POSIX threads variant is the one that has std::thread and std::mutex. What is looked for is what CMAKE_PREFIX_PATH
# says, beside the compiler's own folder: nothing of the machine that compiles. Eigen has headers alone, which are those of the machine:
# say -DEigen3_DIR=/usr/share/eigen3/cmake.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
# A program brings MinGW's libraries along, which no other machine has.
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)

set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32 ${CMAKE_PREFIX_PATH})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(kind IN ITEMS LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
