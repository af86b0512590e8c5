# NvCloth as a static library of its processor path, without its own build system, which needs more than the sources.
set(nvcloth_root "${WEFT_NVCLOTH_DIR}/NvCloth")
if(NOT EXISTS "${nvcloth_root}/include/NvCloth/Factory.h" OR NOT EXISTS "${WEFT_NVCLOTH_DIR}/PxShared/include/foundation/Px.h")
  message(FATAL_ERROR "WEFT_NVCLOTH_DIR is ${WEFT_NVCLOTH_DIR}, which has no NvCloth/include/NvCloth/Factory.h or no "
    "PxShared/include/foundation/Px.h; expected the sources of NvCloth 1.1.6")
endif()
file(GLOB nvcloth_sources "${nvcloth_root}/src/*.cpp")
add_library(weft_nvcloth STATIC EXCLUDE_FROM_ALL ${nvcloth_sources} "${nvcloth_root}/src/ps/unix/PsUnixAtomic.cpp"
  "${nvcloth_root}/include/NvCloth/ps/PsAllocator.cpp")
target_include_directories(weft_nvcloth SYSTEM PUBLIC "${nvcloth_root}/include" "${nvcloth_root}/extensions/include"
  "${WEFT_NVCLOTH_DIR}/PxShared/include" PRIVATE "${nvcloth_root}/src")
target_compile_definitions(weft_nvcloth PUBLIC NDEBUG NV_CLOTH_IMPORT= PX_CALL_CONV= NV_CLOTH_ENABLE_DX11=0 NV_CLOTH_ENABLE_CUDA=0)
# Its code reads floats through pointers to integers.
target_compile_options(weft_nvcloth PRIVATE -O3 -mavx2 -mfma -w -fno-strict-aliasing)
# Names of its files clash in a unity build.
set_target_properties(weft_nvcloth PROPERTIES UNITY_BUILD OFF)
target_sources(weft-bench-peers PRIVATE peers/nvcloth.cpp)
set_source_files_properties(peers/nvcloth.cpp PROPERTIES COMPILE_OPTIONS -fno-strict-aliasing)
target_compile_definitions(weft-bench-peers PRIVATE WEFT_WITH_NVCLOTH)
target_link_libraries(weft-bench-peers PRIVATE weft_nvcloth)
