# Installs the library modules, their headers and the CMake package: find_package(weft 0.1 COMPONENTS ...).
#
# Each module is an export set of its own, so that a user of custom_forces alone does not need Bullet: the package
# loads the bridges, and looks for Bullet, only for those who ask for them.
option(WEFT_INSTALL "Make the install rules" ON)
if(NOT WEFT_INSTALL)
  return()
endif()

include(CMakePackageConfigHelpers)
# What users of the libraries have to link as well: a shared library brings its threads along.
set(weft_thread_package "")
if(NOT BUILD_SHARED_LIBS)
  set(weft_thread_package "${weft_thread_library}")
endif()
set(weft_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/weft")
set(weft_components "")

get_property(modules GLOBAL PROPERTY WEFT_INSTALLED_MODULES)
foreach(target IN LISTS modules)
  get_target_property(component ${target} EXPORT_NAME)
  get_target_property(path ${target} WEFT_PATH)
  get_target_property(headers ${target} WEFT_HEADERS)
  list(APPEND weft_components ${component})
  install(TARGETS ${target} EXPORT weft_${component}
          ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
          LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
          RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
  install(EXPORT weft_${component} NAMESPACE weft:: DESTINATION "${weft_package_dir}"
          FILE weft_${component}.cmake)
  foreach(header IN LISTS headers)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES "${PROJECT_SOURCE_DIR}/${path}/${header}"
            DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/weft/${path}/${folder}")
  endforeach()
endforeach()
if(TARGET weft_bridge OR TARGET weft_bridge_float64)
  install(FILES "${PROJECT_SOURCE_DIR}/bridge/weft.hpp" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/weft")
endif()

include("${PROJECT_SOURCE_DIR}/cmake/weft_pkg_config.cmake")

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/weftConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/weftConfig.cmake" INSTALL_DESTINATION "${weft_package_dir}"
  NO_SET_AND_CHECK_MACRO)
# While the version is 0.x every minor version may change the interface.
set(compatibility SameMajorVersion)
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(compatibility SameMinorVersion)
endif()
write_basic_package_version_file("${PROJECT_BINARY_DIR}/weftConfigVersion.cmake"
  COMPATIBILITY ${compatibility})
install(FILES "${PROJECT_BINARY_DIR}/weftConfig.cmake" "${PROJECT_BINARY_DIR}/weftConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/FindBulletSoftBody.cmake"
        DESTINATION "${weft_package_dir}")
