# SPDX-License-Identifier: Apache-2.0
# Where `cmake --install` puts libvernier, its headers, and what finds it.
include(CMakePackageConfigHelpers)

install(TARGETS libvernier EXPORT vernier COMPONENT common)
install(DIRECTORY include/vernier DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT common FILES_MATCHING PATTERN *.h)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/vernier)
install(EXPORT vernier NAMESPACE vernier:: FILE vernier-targets.cmake DESTINATION ${package_folder}
  COMPONENT common)
configure_package_config_file(packaging/vernier-config.cmake.in ${PROJECT_BINARY_DIR}/vernier-config.cmake
  INSTALL_DESTINATION ${package_folder})
# Before 1.0 another minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vernier-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vernier-config.cmake ${PROJECT_BINARY_DIR}/vernier-config-version.cmake
  DESTINATION ${package_folder} COMPONENT common)

file(RELATIVE_PATH prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(packaging/vernier.pc.in ${PROJECT_BINARY_DIR}/vernier.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/vernier.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT common)

# A folder of scripts as Blender looks for it, and the same for "Install from File": docs/blender.md.
set(blender_folder ${CMAKE_INSTALL_DATADIR}/vernier/blender)
install(DIRECTORY apps/blender/vernier_blender DESTINATION ${blender_folder}/addons COMPONENT common
  FILES_MATCHING PATTERN *.py PATTERN *.toml PATTERN __pycache__ EXCLUDE)
find_package(Python3 COMPONENTS Interpreter QUIET)
if(Python3_Interpreter_FOUND)
  file(GLOB blender_sources CONFIGURE_DEPENDS apps/blender/vernier_blender/*)
  set(blender_zip ${PROJECT_BINARY_DIR}/vernier_blender.zip)
  add_custom_command(OUTPUT ${blender_zip} VERBATIM DEPENDS apps/blender/make_zip ${blender_sources}
    COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/apps/blender/make_zip ${blender_zip})
  add_custom_target(vernier_blender_zip ALL DEPENDS ${blender_zip})
  install(FILES ${blender_zip} DESTINATION ${blender_folder} COMPONENT common)
endif()
