// SPDX-License-Identifier: Apache-2.0
#include <fstream>  // which the implementation forgets where it opens no files
#include <nlohmann/json.hpp>

#define TINYGLTF_IMPLEMENTATION
#include "scene/import/tinygltf.h"
