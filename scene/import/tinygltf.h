// SPDX-License-Identifier: Apache-2.0
#pragma once

// tinygltf as this library uses it: it is given JSON and opens no file or picture itself. It is compiled in,
// by tinygltf.cpp, and not linked as the shared library that there is: Debian's libdraco exports functions of
// the same names of another version, and a program that links it first would run those in their place.

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
