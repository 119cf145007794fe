# SPDX-License-Identifier: Apache-2.0
# Every third-party package in one place; third_party/README.md has version, licence and reason of each.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(Imath REQUIRED)
find_package(OpenImageIO REQUIRED)
# Debian's OpenImageIO names include folders of packages that it does not depend on; CMake refuses folders that are
# not there.
foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
  get_target_property(folders OpenImageIO::OpenImageIO ${property})
  set(there)
  foreach(folder IN LISTS folders)
    if(EXISTS "${folder}")
      list(APPEND there "${folder}")
    endif()
  endforeach()
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${there}")
endforeach()
find_package(PkgConfig REQUIRED)
pkg_check_modules(webp REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(avif REQUIRED IMPORTED_TARGET libavif>=0.11)
# It defines what tells Windows alone that the library is shared, which would keep others from our precompiled header.
set_target_properties(PkgConfig::avif PROPERTIES INTERFACE_COMPILE_OPTIONS "")
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
find_package(ZLIB REQUIRED)
# Debian installs OpenColorIO's CMake files where CMake does not look and with a wrong prefix in them; its pkg-config
# file is right.
find_package(OpenColorIO 2.1 CONFIG QUIET)
if(NOT OpenColorIO_FOUND)
  pkg_check_modules(opencolorio REQUIRED IMPORTED_TARGET OpenColorIO>=2.1)
  add_library(OpenColorIO::OpenColorIO ALIAS PkgConfig::opencolorio)
endif()
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
pkg_check_modules(httplib REQUIRED cpp-httplib)
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)  # its header alone: scene/import/tinygltf.h says why
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)

# Embree 4 when there is one, else 3.13; scene/accel/embree.cpp serves both.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 REQUIRED)
endif()
message(STATUS "Embree ${embree_VERSION}")

# Goes into HTML pages.
find_file(CHART_JS_FILE NAMES chart.min.js chart.umd.js PATHS /usr/share/javascript/chart.js REQUIRED)

if(VERNIER_TESTS)
  find_package(GTest REQUIRED)
endif()

# What the statistics say the program was built with.
foreach(library embree TBB OpenImageIO OpenColorIO opencolorio Imath OpenImageDenoise)
  if(${library}_VERSION)
    list(APPEND VERNIER_LIBRARIES "${library} ${${library}_VERSION}")
  endif()
endforeach()
list(JOIN VERNIER_LIBRARIES "," VERNIER_LIBRARIES)
