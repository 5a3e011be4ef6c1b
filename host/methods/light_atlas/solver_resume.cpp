// A bake that goes on where it was cancelled: with what was measured, where that is kept, else with
// the light that VPLs exchanged and what lies in the texels. The rest is computed anew, which takes
// little.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>

#include "methods/light_atlas/solver_state.hpp"

namespace clgi {
namespace {

template <typename T>
void read(const cl::CommandQueue& queue, const cl::Buffer& buffer, std::size_t count,
          std::vector<T>& values) {
    values.resize(count);
    if (count > 0) queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
}

template <typename T>
void write(Recorder& record, const cl::Buffer& buffer, const std::vector<T>& values) {
    if (!values.empty()) record.write(buffer, values.data(), values.size() * sizeof(T));
}

void need_count(const char* what, std::size_t got, std::size_t needed) {
    if (got != needed)
        throw Error(std::string("light-atlas: the state has ") + std::to_string(got) + " " + what +
                    ", " + std::to_string(needed) + " needed");
}

void need_whole_batches(const char* ends, std::uint32_t done, const LightAtlasState& state,
                        std::uint32_t batch) {
    if (done == 0 || done > state.vpls || (done % batch != 0 && done != state.vpls))
        throw Error(std::string("light-atlas: the state ") + ends + " after VPL " +
                    std::to_string(done) + " of " + std::to_string(state.vpls) +
                    ", the end of a batch needed");
}

}  // namespace

std::optional<LightAtlasState> LightAtlasSolver::state() const {
    const State& s = *state_;
    const light_atlas::Buffers& b = s.b;
    if (s.ended || (b.seen_kept ? s.measured_vpls : s.filled_vpls) == 0) return {};
    s.record.wait();
    LightAtlasState out;
    out.vpls = b.sites.site_count;
    out.texels = b.receiver_count;
    read(s.queue, b.sites.balance, BALANCE_PLANES * std::size_t{b.sites.stride}, out.balance);
    if (b.seen_kept) {
        out.measured_vpls = s.measured_vpls;
        read(s.queue, b.rows, std::size_t{s.measured_vpls} * b.sites.stride, out.rows);
        read(s.queue, b.seen, seen_rows(s.measured_vpls) * b.texel_stride, out.seen);
        return out;
    }
    out.filled_vpls = s.filled_vpls;
    out.shots = s.shots;
    read(s.queue, b.sites.light, SITE_LIGHT_PLANES * std::size_t{b.sites.stride}, out.light);
    read(s.queue, b.gathered, 3 * std::size_t{b.texel_stride}, out.irradiance);
    read(s.queue, b.filled, b.texel_stride, out.filled);
    return out;
}

void LightAtlasSolver::restore(const LightAtlasState& state) {
    const light_atlas::Buffers& b = state_->b;
    const std::size_t vpls = b.sites.stride, texels = b.texel_stride;
    need_count("VPLs", state.vpls, b.sites.site_count);
    need_count("texels and points", state.texels, b.receiver_count);
    need_count("numbers for the balance of VPLs", state.balance.size(), BALANCE_PLANES * vpls);
    if (b.seen_kept) {
        need_whole_batches("was measured", state.measured_vpls, state,
                           std::min<std::uint32_t>(b.batch, SEEN_VPLS));
        need_count("numbers of transport", state.rows.size(), state.measured_vpls * vpls);
        need_count("bytes of visibility", state.seen.size(),
                   seen_rows(state.measured_vpls) * texels);
        need_count("VPLs that have lit texels", state.filled_vpls, 0);
    } else {
        need_whole_batches("ends", state.filled_vpls, state,
                           std::min<std::uint32_t>(b.batch, SEEN_VPLS));
        need_count("numbers for the light of VPLs", state.light.size(), SITE_LIGHT_PLANES * vpls);
        need_count("numbers for irradiance", state.irradiance.size(), 3 * texels);
        need_count("numbers for form factors", state.filled.size(), texels);
    }
    state_->restored = state;
}

// In place of the first part of measuring, once.
void LightAtlasSolver::State::put_back_measurement() {
    write(record, b.sites.balance, restored->balance);
    write(record, b.rows, restored->rows);
    write(record, b.seen, restored->seen);
    measured_vpls = restored->measured_vpls;
    // Balancing changes what it starts from, so it is done once.
    measured = measured_vpls == b.sites.site_count;
    restored.reset();
}

// In place of the exchange, once.
void LightAtlasSolver::State::put_back_light() {
    write(record, b.sites.light, restored->light);
    write(record, b.sites.balance, restored->balance);
    write(record, b.gathered, restored->irradiance);
    write(record, b.filled, restored->filled);
    filled_vpls = restored->filled_vpls;
    if (!measured) measured_vpls = 0;  // their reach is overwritten
    shots = restored->shots;
    restored.reset();
}

}  // namespace clgi
