// How transfer vectors are made: flags of render --method transfer and of transfer.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/dynamic_transfer.hpp>
#include <string>

namespace clgi::program {

struct VectorFlags {
    DynamicTransferOptions solver;
    int order = sh::default_bands - 1;
    int table = 0;  // of half-planes; 0: exact ones
    std::string window = "none";
    int coarse = 0;  // triangles of the mesh that blocks far away; 0: the scene's own
    bool rings_given = false;
};
// prefix: of what each flag is for.
void add_vector_flags(CLI::App& command, const std::string& prefix, VectorFlags& flags);

// Makes the coarse mesh of the scene in its own pose, if the flags want one. Throws Error that
// begins with the command's name for flags that do not go together.
DynamicTransferOptions vector_options(const std::string& command, const VectorFlags& flags,
                                      const Scene& scene, const BuildOptions& build);

// Prints a warning for whatever was not finite; further: packets of pictures.
void warn_of(const TransferStatus& status, std::uint32_t further = 0);

}  // namespace clgi::program
