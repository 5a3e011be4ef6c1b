// What a bake found: the public face of the light atlas solver, and its balance of power.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>

#include "methods/light_atlas/solver_state.hpp"

namespace clgi {
namespace {

std::vector<float> read(const cl::CommandQueue& queue, const cl::Buffer& buffer,
                        std::size_t values) {
    std::vector<float> out(values);
    queue.enqueueReadBuffer(buffer, CL_TRUE, 0, values * sizeof(float), out.data());
    return out;
}

// first: of `count` values in a plane.
std::vector<glm::vec3> colors(const std::vector<float>& planes, std::size_t stride,
                              std::size_t first, std::size_t count, std::size_t first_plane,
                              double exposure) {
    std::vector<glm::vec3> out(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            out[i][static_cast<int>(c)] =
                static_cast<float>(planes[(first_plane + c) * stride + first + i] * exposure);
    return out;
}

}  // namespace

// What all sites reflect of the direct light, before anything was shot. The irradiance is in
// `direct`.
double LightAtlasSolver::State::unshot_power() const {
    const std::size_t stride = b.sites.stride;
    const std::vector<float> planes = read(queue, b.sites.planes, SITE_PLANES * stride);
    double sum = 0.0;
    for (std::size_t i = 0; i < sites.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            sum += double{planes[(SITE_ALBEDO + c) * stride + i]} * direct[c * stride + i] *
                   sites[i].area;
    return sum;
}

LightAtlasSolver::LightAtlasSolver(const Programs& programs, const cl::CommandQueue& queue,
                                   const DeviceScene& scene, const VplLayout& vpls,
                                   const AtlasLayout& atlas, const LightAtlasOptions& options,
                                   const std::vector<BakePoint>& points)
    : state_(std::make_unique<State>(programs, queue, scene, vpls, atlas, options, points)) {}

LightAtlasSolver::~LightAtlasSolver() = default;

void LightAtlasSolver::lights_changed() {
    State& s = *state_;
    s.bytes += s.emitters.follow(s.options.emitters, s.record, s.gbuffer);
}

bool LightAtlasSolver::run(const Progress& progress) { return state_->run(progress, -1.0); }

bool LightAtlasSolver::update(double least, const Progress& progress) {
    State& s = *state_;
    if (!(least >= 0.0))
        throw Error("light-atlas: least is " + std::to_string(least) + ", 0 or more needed");
    return s.run(progress,
                 s.ended && (s.b.seen_kept || !occludes(s.options.occlusion)) ? least : -1.0);
}

LightAtlasStatus LightAtlasSolver::status() const {
    const State& s = *state_;
    s.record.wait();
    LightAtlasStatus out;
    out.non_finite = s.record.read_word(s.b.non_finite);
    out.shots = s.shots;
    out.transport_kept = s.b.kept;
    out.visibility_kept = s.b.seen_kept;
    if (s.ended) out.sent = s.record.read_word(s.b.sites.listed);
    out.converged = s.ended;
    if (s.direct.empty()) return out;
    const std::size_t stride = s.b.sites.stride;
    const auto planes = read(s.queue, s.b.sites.planes, SITE_PLANES * stride);
    const auto light = read(s.queue, s.b.sites.light, SITE_LIGHT_PLANES * stride);
    const auto balance = read(s.queue, s.b.sites.balance, BALANCE_PLANES * stride);
    // Exposed local units to lumen: exposure, and metres squared.
    const double lumen = s.scene.frame().exposure / (s.scene.frame().scale * s.scene.frame().scale);
    for (std::size_t i = 0; i < s.sites.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double area = s.sites[i].area * lumen;
            const double reflected = area * planes[(SITE_ALBEDO + c) * stride + i];
            const double direct = s.direct[c * stride + i];
            const double unshot = light[(SITE_UNSHOT + c) * stride + i];
            const double all = light[(SITE_RECEIVED + c) * stride + i];
            const double shot = reflected * (all - unshot);
            out.power_direct += reflected * direct;
            out.power_left += reflected * unshot;
            out.power_shot += shot;
            out.power_received += area * (all - direct);
            out.power_lost += shot * (1.0 - balance[BALANCE_REACH * stride + i]);
        }
    out.converged = s.ended && out.power_left <= s.options.threshold * out.power_direct;
    return out;
}

std::vector<glm::vec3> LightAtlasSolver::irradiance() const {
    const State& s = *state_;
    s.record.wait();
    return colors(read(s.queue, s.b.irradiance, 3 * std::size_t{s.b.texel_stride}),
                  s.b.texel_stride, 0, s.b.texel_count, 0, s.scene.frame().exposure);
}

std::vector<glm::vec3> LightAtlasSolver::point_irradiance() const {
    const State& s = *state_;
    s.record.wait();
    return colors(read(s.queue, s.b.irradiance, 3 * std::size_t{s.b.texel_stride}),
                  s.b.texel_stride, s.b.first_point, s.bake_points.size(), 0,
                  s.scene.frame().exposure);
}

std::vector<glm::vec3> LightAtlasSolver::vpl_irradiance() const {
    const State& s = *state_;
    s.record.wait();
    const std::size_t stride = s.b.sites.stride;
    return colors(read(s.queue, s.b.sites.light, SITE_LIGHT_PLANES * stride), stride, 0,
                  s.sites.size(), SITE_RECEIVED, s.scene.frame().exposure);
}

const cl::Buffer& LightAtlasSolver::irradiance_planes() const { return state_->b.irradiance; }
std::uint32_t LightAtlasSolver::stride() const { return state_->b.texel_stride; }
const cl::Buffer& LightAtlasSolver::texel_planes() const { return state_->b.texels.planes; }
const SiteBuffers& LightAtlasSolver::sites() const { return state_->b.sites; }
std::size_t LightAtlasSolver::bytes() const { return state_->bytes; }
const std::vector<PassEvent>& LightAtlasSolver::events() const { return state_->record.events(); }
Interval LightAtlasSolver::interval() const { return state_->record.interval(); }
const LightAtlasOptions& LightAtlasSolver::options() const { return state_->options; }

}  // namespace clgi
