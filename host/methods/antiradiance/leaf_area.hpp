// How often a face is halved, and the area of leaves that gives a requested number of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/elements.hpp>
#include <vector>

#include "methods/antiradiance/faces.hpp"

namespace clgi {

// Halvings after which a part of the face has at most this area, but for rounding.
int halvings(double area, double max_area);

// Leaves of all faces; a double, because options may ask for more than there is memory for.
double count_leaves(const std::vector<Face>& faces, double max_area);

// m^2; infinite for no faces.
double leaf_area(const std::vector<Face>& faces, const ElementOptions& options);

}  // namespace clgi
