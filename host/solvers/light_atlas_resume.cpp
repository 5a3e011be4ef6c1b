// A bake that goes on where it was cancelled. Direct light, and how samples share it, is computed
// anew, which takes little; the light that VPLs exchanged and what lies in the texels is kept.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>

#include "solvers/light_atlas_state.hpp"

namespace clgi {

std::optional<LightAtlasState> LightAtlasSolver::state() const {
    const State& s = *state_;
    if (s.ended || s.filled_vpls == 0) return {};
    s.record.wait();
    LightAtlasState out;
    out.vpls = s.b.sites.site_count;
    out.texels = s.b.texel_count;
    out.filled_vpls = s.filled_vpls;
    out.shots = s.shots;
    const auto read = [&](std::vector<float>& values, const cl::Buffer& buffer, std::size_t planes,
                          std::size_t stride) {
        values.resize(planes * stride);
        s.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(float), values.data());
    };
    read(out.light, s.b.sites.light, SITE_LIGHT_PLANES, s.b.sites.stride);
    read(out.balance, s.b.sites.balance, BALANCE_PLANES, s.b.sites.stride);
    read(out.irradiance, s.b.irradiance, 3, s.b.texel_stride);
    read(out.filled, s.b.filled, 1, s.b.texel_stride);
    return out;
}

void LightAtlasSolver::restore(const LightAtlasState& state) {
    const light_atlas::Buffers& b = state_->b;
    const auto need = [](const char* what, std::size_t got, std::size_t needed) {
        if (got != needed)
            throw Error(std::string("light-atlas: the state has ") + std::to_string(got) + " " +
                        what + ", " + std::to_string(needed) + " needed");
    };
    need("VPLs", state.vpls, b.sites.site_count);
    need("texels", state.texels, b.texel_count);
    need("numbers for the light of VPLs", state.light.size(),
         SITE_LIGHT_PLANES * std::size_t{b.sites.stride});
    need("numbers for their balance", state.balance.size(),
         BALANCE_PLANES * std::size_t{b.sites.stride});
    need("numbers for irradiance", state.irradiance.size(), 3 * std::size_t{b.texel_stride});
    need("numbers for form factors", state.filled.size(), b.texel_stride);
    if (state.filled_vpls == 0 || state.filled_vpls > state.vpls ||
        (state.filled_vpls % b.filling_batch != 0 && state.filled_vpls != state.vpls))
        throw Error("light-atlas: the state ends after VPL " + std::to_string(state.filled_vpls) +
                    " of " + std::to_string(state.vpls) + ", the end of a batch needed");
    state_->restored = state;
}

// Takes the place of the exchange, once.
void LightAtlasSolver::State::put_back() {
    const auto write = [&](const cl::Buffer& buffer, const std::vector<float>& values) {
        record.write(buffer, values.data(), values.size() * sizeof(float));
    };
    write(b.sites.light, restored->light);
    write(b.sites.balance, restored->balance);
    write(b.irradiance, restored->irradiance);
    write(b.filled, restored->filled);
    filled_vpls = restored->filled_vpls;
    shots = restored->shots;
    restored.reset();
}

}  // namespace clgi
