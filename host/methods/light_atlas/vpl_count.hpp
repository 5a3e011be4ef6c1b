// How many VPLs options ask for.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/vpl_layout.hpp>
#include <cstdint>

namespace clgi {

// m^2, both sides of double-sided patches.
double area_of(const Patches& patches);

// Throws Error for options and patches that place_vpls refuses.
std::uint32_t vpl_count(const Scene& scene, const Patches& patches, const VplOptions& options);

}  // namespace clgi
