// The error that a plan expects of its picture, against all light.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>
#include <optional>
#include <string>

namespace clgi {

// Root of the mean squared difference of luminance over the mean luminance, of indirect and of
// direct light together: what the preset erred by in scenes of the kind, times the share of
// indirect light that the probe found; and what the probe found of direct light, by how fine that
// is. None where nothing was measured. plan: as the preset sets it; of_kind: of the preset, in
// scenes of the kind.
std::optional<double> expected_error(const Plan& plan, double of_kind);

// How many times as large as in scenes of their kind errors of indirect light are here, by any
// method: as the doubt of the last picture says, and at least 1, because records that agree may all
// lack the same light. 1 once a check has measured an error.
double doubt_factor(const Plan& plan);

// Whether errors of the plan's method are those of the whole picture, the sky's light with it.
bool gathers_the_sky(const Plan& plan);

// Whether direct light has no error: of points and directions with nothing that shadows it.
bool has_exact_direct_light(const Plan& plan);

// Whether the plan lacks an effect because of the request: then its error against all light is not
// known, but errors of settings can be compared.
bool left_out_by_request(const Plan& plan);

// What the expected error of a plan is based on.
std::string evidence_of_error(const Plan& plan);

}  // namespace clgi
