// The one file that compiles tinygltf.
// SPDX-License-Identifier: MIT
#include "io/gltf_tiny.hpp"

#include <fstream>  // which tinygltf forgets where it has no files of its own

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
