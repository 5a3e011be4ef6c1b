// The one file that compiles tinygltf.
// SPDX-License-Identifier: MIT
#include <fstream>  // which tinygltf forgets where it has no files of its own

#define TINYGLTF_IMPLEMENTATION
#include "io/gltf_tiny.hpp"
