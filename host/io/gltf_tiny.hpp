// tinygltf as clgi uses it: files and images reach it through callbacks alone, and its names
// stand in a namespace of their own, since a program that links clgi::io may carry another
// tinygltf.
// SPDX-License-Identifier: MIT
#pragma once

#define TINYGLTF_NOEXCEPTION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE  // read where a material needs them, within a budget
#define tinygltf clgi_tinygltf
#include <tiny_gltf.h>
