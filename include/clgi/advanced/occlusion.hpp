// Whether surfaces hide others from light: one switch for all methods.
// SPDX-License-Identifier: MIT
#pragma once

namespace clgi {

enum class Occlusion {
    none,       // nothing lies between two surfaces: light arrives whatever is in its way
    automatic,  // where something may lie between
    always,     // also where nothing can; the same light, for measurements of what automatic saves
};

constexpr bool occludes(Occlusion occlusion) { return occlusion != Occlusion::none; }

}  // namespace clgi
