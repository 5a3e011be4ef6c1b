// A sweep of dynamic transfer: irradiance at the vertices of a scene under its environment, against
// the path tracer at the same vertices.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/dynamic_transfer.hpp>

#include "lab/sweep.hpp"

namespace clgi::lab {

inline constexpr const char* transfer_fine = "transfer";
inline constexpr const char* transfer_levels = "two-level transfer";
inline constexpr const char* transfer_sets = "transfer with visible sets";

// What irradiance is compared with, of Sweep::truths.
enum IrradianceTruth : std::size_t {
    full_environment,   // the picture as it is: what light in so few bands lacks is part of the
                        // error
    smooth_environment  // its first five bands alone, smoothed until no direction is below 0: with
                        // five bands or more, what is left is the error of the vectors
};

// The motion that the pose of a sweep is a moment of.
struct TransferSweep {
    const Scene* animated = nullptr;  // with animation, before it was posed; null: it stands still
    std::size_t clip = 0;
};

// Methods transfer_fine, transfer_levels and transfer_sets, timed over transfer() alone, warm;
// truths "full" and "smooth". Lights other than the environment are left out. Vertices count that
// have triangles and sees_sky(), with their front sides. Throws what its parts throw, InputError
// for a scene without environment or without triangles, and Error when cancelled.
Sweep sweep_transfer(const SweepSetup& setup, const TransferSweep& motion = {});

// The settings that such a sweep tries, by series: the knob that is varied alone, from the least
// accurate value on, or "grid". coarse: triangles of the far mesh; 0: none.
struct TransferSettings : SweepSetting {
    DynamicTransferOptions options;  // without the mesh itself
    std::size_t coarse = 0;
    int looks = 0;  // frames whose potentially visible sets masks look at; 0: at all triangles
};
// triangles: of the scene. levels: whether meshes can be simplified. moves: whether visible sets
// are of the frames of a clip; else of the pose itself.
std::vector<TransferSettings> transfer_settings(bool quick, std::size_t triangles, bool levels,
                                                bool moves, const BuildOptions& build = {});

// Radiance in the first bands of an environment's coefficients, smoothed by smoothing_window until
// it is nowhere below 0 in any channel, and the picture of it.
std::vector<glm::dvec3> smoothed_light(std::vector<glm::dvec3> coefficients);
Environment picture_of_light(const std::vector<glm::dvec3>& coefficients, int width);

// Whether a vertex that receives so much of this light, lux, gets a hundredth of what it would get
// with nothing around it. Others lie inside of something, such as skin under a nail: no picture
// shows them, and whether they are a hair below or above its surface would be most of the error.
bool sees_sky(const glm::dvec3& irradiance, const std::vector<glm::dvec3>& light,
              const glm::vec3& normal);

}  // namespace clgi::lab
