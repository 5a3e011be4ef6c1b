// Checks of what describes the emitters, before a kernel is enqueued.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/lights.hpp>

#include "core/opencl/launch.hpp"

namespace clgi {

inline void need_emitters(const PassKernel& pass, const EmitterBuffers& sources,
                          std::size_t emitters) {
    need(pass, "views", sources.views, sources.view_count * sizeof(View));
    need(pass, "visibility", sources.visibility, sources.pixels * pixel_bytes(sources.kind));
    need(pass, "emitters", sources.emitters, emitters * sizeof(Emitter));
}

inline void need_depth_words(const PassKernel& pass, std::uint32_t words, Pixels kind) {
    const std::uint32_t needed = kind == Pixels::depth ? 1 : 2;
    if (words != needed)
        throw Error(pass.name + ": depth_words is " + std::to_string(words) + ", " +
                    std::to_string(needed) + " needed for these shadow maps");
}

}  // namespace clgi
