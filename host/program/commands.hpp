// The commands of the program; each adds its flags to app and runs when it is chosen.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>

namespace clgi::program {

void add_devices(CLI::App& app);
void add_scene(CLI::App& app);
void add_plan(CLI::App& app);
void add_render(CLI::App& app);
void add_view(CLI::App& app);  // of programs with CLGI_VIEW
void add_bake(CLI::App& app);
void add_transfer(CLI::App& app);
void add_reference(CLI::App& app);
void add_verify(CLI::App& app);
void add_compare(CLI::App& app);
void add_sweep(CLI::App& app);
void add_bench(CLI::App& app);

}  // namespace clgi::program
