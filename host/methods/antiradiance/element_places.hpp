// Elements and moving links as the passes for geometry that moves take them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/moving_elements.h>
#include <clgi/advanced/direction_bins.hpp>
#include <clgi/advanced/elements.hpp>
#include <clgi/device_scene.hpp>
#include <vector>

namespace clgi {

// [elements] where the tree has them, with radii that hold their subtrees in all poses.
std::vector<ElementPlace> element_places(const ElementTree& tree,
                                         const std::vector<ElementTree>& poses,
                                         const DirectionBins& bins, const Scene& scene,
                                         const DeviceScene& device);

}  // namespace clgi
