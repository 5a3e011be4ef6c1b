// The version that the build gives.
// SPDX-License-Identifier: MIT
#pragma once

#ifndef CLGI_VERSION
#define CLGI_VERSION "unversioned"
#endif
