// --verify: a picture is checked by a few path-traced pixels before it is saved.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/io/image.hpp>
#include <clgi/reference.hpp>
#include <clgi/scene.hpp>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace clgi::program {

struct VerifyFlags {
    bool on = false;
    std::string time;  // "2s"; empty: a share of the time that was spent before
};
// what: that is checked, such as "picture".
void add_verify_flag(CLI::App& command, VerifyFlags& flags, const std::string& what);

// What of a pixel is looked through; empty: what the picture says, else its centre.
void add_filter_flag(CLI::App& command, std::string& filter);
reference::Filter filter_of(const std::string& name);

// Throws Error that begins with the command's name for a time that is none.
void check_verify(const std::string& command, const VerifyFlags& flags);

// Checks with a path tracer of the scene: check(tracer, options). spent: seconds that were spent
// before. The seconds of the result include building the path tracer. Nothing if the check was
// cancelled, or, with a warning, if it is not possible.
using Check = std::function<reference::Verification(const reference::PathTracer& tracer,
                                                    const reference::VerifyOptions& options)>;
std::optional<reference::Verification> verify(const Scene& scene, const VerifyFlags& flags,
                                              double spent, const Check& check);

// "measured error 4.2 % (3.5 to 4.9), energy 0.990 (0.981 to 1.002)".
std::string verify_line(const reference::Verification& found);

// "the plan expected an error of 5 %, measured 41 %" if the expected error is below the interval.
std::string expected_less(std::optional<double> expected, const reference::Verification& found);

nlohmann::ordered_json verify_json(const reference::Verification& found);

// Which pixels of a picture have most of the squared error: a line for each that has a tenth of it,
// none where the error may be 0; and the same for programs.
std::string largest_lines(const reference::Verification& found);
nlohmann::ordered_json picture_json(const reference::Verification& found);

// Adds the attributes clgi:measured_error, clgi:measured_energy and their _low and _high.
void add_verified(io::Image& picture, const reference::Verification& found);

}  // namespace clgi::program
