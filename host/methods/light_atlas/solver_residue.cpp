// What rounding leaves in texels whose light was taken away again.
//
// A sum of differences is as exact as the largest sum that it ever was: the residue of light that
// is gone has either sign. Where it would show, all light is sent anew.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "methods/light_atlas/solver_state.hpp"

namespace clgi {
namespace {

// Of the brightest that a texel was: 16 roundings, of sums of some hundreds of terms that are added
// and taken away again.                          [derived: rounding errors go as the root of terms]
constexpr float residue = 0x1p-20f;
// Shares from which on it shows: of the light that a texel has; where it has none but the residue,
// of the mean of all.
constexpr float shows = 0x1p-7f, shows_in_the_dark = 0x1p-13f;
// Light that falls in on a texel at a grazing angle alone may be as little as that in any scene.
constexpr std::size_t one_in = 1024;

}  // namespace

// The brightest channel of every texel and point, exposed lux. Waits.
std::vector<float> LightAtlasSolver::State::light_of_texels() const {
    std::vector<float> planes(3 * std::size_t{b.texel_stride}), out(b.receiver_count);
    const WaitList pending = record.waits();
    queue.enqueueReadBuffer(b.gathered, CL_TRUE, 0, planes.size() * sizeof(float), planes.data(),
                            &pending);
    for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            out[i] = std::max(out[i], std::abs(planes[c * b.texel_stride + i]));
    return out;
}

void LightAtlasSolver::State::note_brightest() {
    record.wait();
    const std::vector<float> now = light_of_texels();
    brightest.resize(now.size(), 0.0f);
    for (std::size_t i = 0; i < now.size(); ++i) brightest[i] = std::max(brightest[i], now[i]);
}

bool LightAtlasSolver::State::residue_shows() {
    record.wait();
    const std::vector<float> now = light_of_texels();
    double sum = 0.0;
    for (std::size_t i = 0; i < b.texel_count; ++i) sum += double{now[i]};
    const float dark = shows_in_the_dark * static_cast<float>(sum / b.texel_count);
    std::size_t shown = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const float left = residue * brightest[i];
        shown += left > (now[i] > left ? shows * now[i] : dark);
    }
    return shown * one_in > now.size();
}

// Nothing was sent to the texels yet.
void LightAtlasSolver::State::clear_texels() {
    for (const cl::Buffer* buffer : {&b.sites.sent, &b.gathered, &b.filled})
        record.fill(*buffer, 0);
    brightest.clear();
    filled_vpls = 0;
}

void LightAtlasSolver::State::send_anew() {
    differences = false;
    clear_texels();
    send(-1.0f);
    fill();
}

}  // namespace clgi
