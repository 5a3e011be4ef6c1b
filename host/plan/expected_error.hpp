// The error that a plan expects of its picture, against all light.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>
#include <optional>
#include <string>

#include "plan/presets.hpp"

namespace clgi {

// Root of the mean squared difference of luminance over the mean luminance, of indirect and of
// direct light together: what the preset erred by in scenes of the kind, times the share of
// indirect light that the probe found; and what the probe found of direct light, by how fine that
// is. None where nothing was measured. plan: as the preset sets it.
std::optional<double> expected_error(const Plan& plan, const Preset& preset);

// Whether direct light has no error: of points and directions with nothing that shadows it.
bool has_exact_direct_light(const Plan& plan);

// Whether the plan lacks an effect because of the request: then its error against all light is not
// known, but errors of settings can be compared.
bool left_out_by_request(const Plan& plan);

// What the expected error of a plan is based on.
std::string evidence_of_error(const Plan& plan);

}  // namespace clgi
