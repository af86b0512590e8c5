# Finds Bullet's soft-body libraries and makes one imported target per precision:
#   BulletSoftBody::float32   libBullet*            (btScalar = float)
#   BulletSoftBody::float64   libBullet*-float64    (btScalar = double, BT_USE_DOUBLE_PRECISION)
#
# One of the two is enough: BulletSoftBody_float32_FOUND and BulletSoftBody_float64_FOUND say which are there.
#
# Why an own finder: CMake's FindBullet knows only the single-precision names and sets no definition, and Bullet's
# own BulletConfig.cmake has a relative include path and names a library of another package. Mixing a definition
# with the other library links without a word and corrupts memory, so each target carries both, and the interface
# property WEFT_BULLET_PRECISION makes CMake itself refuse a program that links the two.
find_path(BulletSoftBody_INCLUDE_DIR BulletSoftBody/btSoftBody.h PATH_SUFFIXES bullet)
set(_bsb_components BulletSoftBody BulletDynamics BulletCollision LinearMath)
foreach(_precision IN ITEMS float32 float64)
  set(_suffix "")
  if(_precision STREQUAL "float64")
    set(_suffix "-float64")
  endif()
  set(_missing "")
  foreach(_component IN LISTS _bsb_components)
    find_library(BulletSoftBody_${_component}_${_precision}_LIBRARY ${_component}${_suffix})
    mark_as_advanced(BulletSoftBody_${_component}_${_precision}_LIBRARY)
    if(NOT BulletSoftBody_${_component}_${_precision}_LIBRARY)
      list(APPEND _missing lib${_component}${_suffix})
    endif()
  endforeach()
  set(BulletSoftBody_${_precision}_FOUND TRUE)
  if(_missing OR NOT BulletSoftBody_INCLUDE_DIR)
    set(BulletSoftBody_${_precision}_FOUND FALSE)
    list(JOIN _missing ", " BulletSoftBody_${_precision}_MISSING)
  endif()
endforeach()
if(BulletSoftBody_INCLUDE_DIR)
  file(STRINGS "${BulletSoftBody_INCLUDE_DIR}/LinearMath/btScalar.h" _line REGEX "define BT_BULLET_VERSION [0-9]+")
  string(REGEX REPLACE ".*BT_BULLET_VERSION ([0-9])([0-9]+).*" "\\1.\\2" BulletSoftBody_VERSION "${_line}")
endif()
# What is missing of the precision that is looked for first, should there be neither.
set(_bsb_required BulletSoftBody_INCLUDE_DIR)
if(NOT BulletSoftBody_float32_FOUND AND NOT BulletSoftBody_float64_FOUND)
  foreach(_component IN LISTS _bsb_components)
    list(APPEND _bsb_required BulletSoftBody_${_component}_float32_LIBRARY)
  endforeach()
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletSoftBody REQUIRED_VARS ${_bsb_required} VERSION_VAR BulletSoftBody_VERSION)

if(BulletSoftBody_FOUND)
  foreach(_precision IN ITEMS float32 float64)
    if(NOT BulletSoftBody_${_precision}_FOUND)
      continue()
    endif()
    if(TARGET BulletSoftBody::${_precision})
      continue()
    endif()
    set(_libraries "")
    foreach(_component IN LISTS _bsb_components)
      list(APPEND _libraries "${BulletSoftBody_${_component}_${_precision}_LIBRARY}")
    endforeach()
    add_library(BulletSoftBody::${_precision} INTERFACE IMPORTED)
    set_target_properties(BulletSoftBody::${_precision} PROPERTIES
      INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${BulletSoftBody_INCLUDE_DIR}"
      INTERFACE_INCLUDE_DIRECTORIES "${BulletSoftBody_INCLUDE_DIR}"
      INTERFACE_LINK_LIBRARIES "${_libraries}"
      INTERFACE_WEFT_BULLET_PRECISION ${_precision}
      COMPATIBLE_INTERFACE_STRING WEFT_BULLET_PRECISION)
  endforeach()
  if(TARGET BulletSoftBody::float64)
    set_property(TARGET BulletSoftBody::float64 PROPERTY INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION)
  endif()
endif()
mark_as_advanced(BulletSoftBody_INCLUDE_DIR)
