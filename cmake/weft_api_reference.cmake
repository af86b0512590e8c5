# The target api_reference: pages of all installed headers, in build/<preset>/api_reference/html. Needs Doxygen; without it there
# is no such target.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()

get_property(modules GLOBAL PROPERTY WEFT_INSTALLED_MODULES)
set(weft_documented "")
foreach(target IN LISTS modules)
  get_target_property(path ${target} WEFT_PATH)
  get_target_property(headers ${target} WEFT_HEADERS)
  foreach(header IN LISTS headers)
    list(APPEND weft_documented "${PROJECT_SOURCE_DIR}/${path}/${header}")
  endforeach()
endforeach()
# It specializes a template of Eigen's, which Doxygen takes for a mistake; programs do not differentiate.
list(FILTER weft_documented EXCLUDE REGEX "/core/tangent\\.hpp$")
list(REMOVE_DUPLICATES weft_documented) # both precisions of the bridge have the same

set(DOXYGEN_PROJECT_NAME Weft)
set(DOXYGEN_PROJECT_BRIEF "Cloth and soft characters for the Bullet physics engine")
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/api_reference")
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE "${PROJECT_SOURCE_DIR}/docs/api_reference.md")
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_EXTRACT_ALL YES)
set(DOXYGEN_HIDE_UNDOC_RELATIONS YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_GENERATE_TREEVIEW YES)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
# As a program sees it: without the inline namespace that keeps the two precisions apart.
set(DOXYGEN_INPUT_FILTER "sed -e 's|^inline namespace WEFT_BULLET_PRECISION {||' -e 's|^}  // namespace WEFT_BULLET_PRECISION||'")
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}")
doxygen_add_docs(api_reference "${PROJECT_SOURCE_DIR}/docs/api_reference.md" ${weft_documented}
                 COMMENT "Reading ${PROJECT_NAME}'s installed headers")
