# SPDX-License-Identifier: Apache-2.0
# What is installed beside the programs, and the Debian package: docs/packaging.md.
install(FILES README.md CHANGELOG.md SECURITY.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT common)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT common)
install(FILES packaging/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT common)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vernier)
set(CPACK_PACKAGE_CONTACT "Vernier maintainers <maintainers@vernier.invalid>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/package)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL OFF)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Renders glTF 2.0 scenes by ray casting, Whitted ray tracing or unbiased path
tracing, and says how wrong each picture is, with an interval. Renders for a
number of samples, a time, or an error; the same picture for any number of
threads.")
# Programs of other build folders of the same sources, for other levels of processor, go into the same package.
set(VERNIER_OTHER_BUILDS "" CACHE STRING "Build folders whose programs are packed too")
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};vernier;ALL;/")
foreach(folder IN LISTS VERNIER_OTHER_BUILDS)
  list(APPEND CPACK_INSTALL_CMAKE_PROJECTS "${folder};vernier;program;/")
endforeach()
include(CPack)
