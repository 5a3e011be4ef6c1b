// The decision between zero copy and copy, apart from where its analysis come from.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/gl/sharing.hpp>
#include <string>
#include <vector>

namespace clgi::gl {

struct SharingCapabilities {
    std::string extensions;                         // of the device
    bool images = false;                            // the device has them
    std::vector<cl_context_properties> properties;  // that the OpenCL context was made with
    void* current = nullptr;                        // OpenGL context of this thread
    std::string missing;                            // entry point that the platform lacks, or empty
};

// Sets zero_copy, reason and implicit.
Sharing decide(const SharingCapabilities& analysis);

// Whether a list of extensions, separated by spaces, has this one.
bool lists_extension(const std::string& extensions, const std::string& wanted);

}  // namespace clgi::gl
