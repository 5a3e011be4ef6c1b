// SPDX-License-Identifier: MIT
#include <clgi/passes/vpl.hpp>

#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>
#include <string>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"

namespace clgi {
namespace {

SiteParams site_params(const SiteBuffers& b) {
    return {b.site_count, b.stride, b.sample_count, b.sample_stride};
}

void need_sites(const PassKernel& pass, const SiteBuffers& b) {
    need_stride(pass, "stride", b.stride, b.site_count);
    need_stride(pass, "sample_stride", b.sample_stride, std::size_t{b.sample_count} + b.site_count);
    need(pass, "sites", b.sites, b.site_count * sizeof(Site));
    need(pass, "planes", b.planes, SITE_PLANES * word * b.stride);
    need(pass, "samples", b.samples, GBUFFER_PLANES * word * b.sample_stride);
}

// Throws Error for points that no packet holds.
void need_points(const PassKernel& pass, const SiteBuffers& b) {
    if (b.most_samples == 0) throw Error(pass.name + ": most_samples is 0, at least 1 needed");
    if (b.per_site != points_per_site(b.most_samples))
        throw Error(pass.name + ": per_site is " + std::to_string(b.per_site) + ", " +
                    std::to_string(points_per_site(b.most_samples)) + " needed for " +
                    std::to_string(b.most_samples) + " samples");
    need_stride(pass, "point_stride", b.point_stride, std::size_t{b.site_count} * b.per_site);
    need(pass, "points", b.points, SITE_POINT_PLANES * word * b.point_stride);
}

std::size_t last_shooter(std::uint32_t first, std::uint32_t count) {
    return std::size_t{first} + count;
}

void need_rows(const PassKernel& pass, const SiteBuffers& b, const cl::Buffer& rows,
               std::uint32_t kept, std::uint32_t shooters) {
    need(pass, "rows", rows,
         std::size_t{kept ? b.site_count : shooters} * b.stride * sizeof(cl_half));
}

void need_exchange(const PassKernel& pass, const TransportParams& params, const SiteBuffers& b,
                   const cl::Buffer& rows) {
    need_sites(pass, b);
    need_points(pass, b);
    need(pass, "chosen", b.chosen, last_shooter(params.first_shooter, params.shooter_count) * word);
    need_rows(pass, b, rows, params.kept, params.shooter_count);
}

// Work-items for all points: a packet holds those of several sites, of one, or a part of them.
std::size_t packets_of_points(const PassKernel& pass, const SiteBuffers& b) {
    const std::size_t together =
        std::max<std::size_t>(std::size_t(pass.packet_width) / b.per_site, 1);
    return (b.site_count + together - 1) / together;
}

TransportParams with_points(TransportParams params, const SiteBuffers& b) {
    params.most_samples = b.most_samples;
    params.per_site = b.per_site;
    params.point_stride = b.point_stride;
    return params;
}

}  // namespace

VplPasses::VplPasses(const Programs& programs, const BuildOptions& options) {
    const std::vector<std::string> single = {"place", "points", "receive", "reach", "emit", "send"},
                                   packets = {"transport", "balance_receivers", "balance_shooters",
                                              "shoot"};
    const auto few = [&](const char* pass, const BuildOptions& how,
                         const std::vector<std::string>& together) {
        return in_small_groups(programs.kernel("vpl", pass, how, "", together), programs.device(),
                               options);
    };
    place_ = few("place", scalar(options), single);
    points_ = programs.kernel("vpl", "points", scalar(options), "", single);
    receive_ = few("receive", scalar(options), single);
    transport_ = few("transport", full(options), packets);
    transport_open_ =
        in_small_groups(programs.kernel("vpl", "transport", full(options), "-DCLGI_OPEN"),
                        programs.device(), options);
    transport_open_.name = "vpl.transport_open";
    reach_open_ = few("reach_open", full(options), {});
    reach_ = few("reach", scalar(options), single);
    balance_receivers_ = few("balance_receivers", full(options), packets);
    balance_shooters_ = few("balance_shooters", full(options), packets);
    emit_ = few("emit", scalar(options), single);
    shoot_ = few("shoot", full(options), packets);
    send_ = few("send", scalar(options), single);
}

void VplPasses::build(std::initializer_list<const char*> passes) const {
    build_named({place_, points_, receive_, transport_, transport_open_, reach_, reach_open_,
                 balance_receivers_, balance_shooters_, emit_, shoot_, send_},
                passes);
}

cl::Event VplPasses::place(const cl::CommandQueue& queue, const DeviceScene& scene,
                           const SiteBuffers& b, const cl::Buffer& ids,
                           const WaitList& wait) const {
    need_sites(place_, b);
    need(place_, "ids", ids, GBUFFER_ID_PLANES * word * b.sample_stride);
    return launch(place_, queue, b.site_count, wait, site_params(b), b.sites, scene.materials(),
                  ids, b.samples, b.planes);
}

cl::Event VplPasses::points(const cl::CommandQueue& queue, const SiteBuffers& b,
                            const WaitList& wait) const {
    need_sites(points_, b);
    need_points(points_, b);
    const PointParams params{
        b.site_count, b.sample_stride, b.most_samples, b.per_site, b.point_stride, 0, 0, 0};
    return launch(points_, queue, b.site_count > 0 ? b.point_stride : 0, wait, params, b.sites,
                  b.samples, b.points);
}

cl::Event VplPasses::receive(const cl::CommandQueue& queue, const SiteBuffers& b,
                             const cl::Buffer& irradiance, const WaitList& wait) const {
    need_sites(receive_, b);
    need(receive_, "irradiance", irradiance, IRRADIANCE_PLANES * word * b.sample_stride);
    need(receive_, "light", b.light, SITE_LIGHT_PLANES * word * b.stride);
    return launch(receive_, queue, b.site_count, wait, site_params(b), b.sites, irradiance,
                  b.light);
}

cl::Event VplPasses::send(const cl::CommandQueue& queue, const SiteBuffers& b,
                          const cl::Buffer& irradiance, float least, const WaitList& wait) const {
    need_sites(send_, b);
    need(send_, "irradiance", irradiance, IRRADIANCE_PLANES * word * b.sample_stride);
    need(send_, "light", b.light, SITE_LIGHT_PLANES * word * b.stride);
    need(send_, "sent", b.sent, 3 * word * b.sample_stride);
    need(send_, "sample_power", b.sample_power, 3 * word * b.sample_stride);
    need(send_, "site_power", b.site_power, 3 * word * b.stride);
    need(send_, "sends", b.sends, b.site_count);
    const SendParams params{b.site_count, b.stride, b.sample_stride, least};
    return launch(send_, queue, b.site_count, wait, params, b.sites, b.planes, irradiance, b.light,
                  b.samples, b.sent, b.sample_power, b.site_power, b.sends);
}

cl::Event VplPasses::transport(const cl::CommandQueue& queue, const TransportParams& params,
                               const SiteBuffers& b, const cl::Buffer& views,
                               const cl::Buffer& depth, const cl::Buffer& rows,
                               const WaitList& wait) const {
    need_exchange(transport_, params, b, rows);
    need(transport_, "views", views, 5 * std::size_t{params.shooter_count} * sizeof(View));
    need(transport_, "depth", depth, 3 * word * params.shooter_count * params.size * params.size);
    return launch_rows(transport_, queue, packets_of_points(transport_, b), params.shooter_count,
                       wait, with_points(params, b), b.chosen, views, depth, b.sites, b.planes,
                       b.samples, b.points, rows);
}

cl::Event VplPasses::transport_open(const cl::CommandQueue& queue, const TransportParams& params,
                                    const SiteBuffers& b, const cl::Buffer& rows,
                                    const WaitList& wait) const {
    need_exchange(transport_open_, params, b, rows);
    return launch_rows(transport_open_, queue, packets_of_points(transport_open_, b),
                       (params.shooter_count + TRANSPORT_SHOOTERS - 1) / TRANSPORT_SHOOTERS, wait,
                       with_points(params, b), b.chosen, b.sites, b.planes, b.samples, b.points,
                       rows);
}

cl::Event VplPasses::reach(const cl::CommandQueue& queue, const TransportParams& params,
                           const SiteBuffers& b, const cl::Buffer& views, const cl::Buffer& depth,
                           const WaitList& wait) const {
    need_sites(reach_, b);
    need(reach_, "chosen", b.chosen,
         last_shooter(params.first_shooter, params.shooter_count) * word);
    need(reach_, "views", views, 5 * std::size_t{params.shooter_count} * sizeof(View));
    need(reach_, "depth", depth, 3 * word * params.shooter_count * params.size * params.size);
    need(reach_, "balance", b.balance, BALANCE_PLANES * word * b.stride);
    return launch(reach_, queue, params.shooter_count, wait, params, b.chosen, views, depth,
                  b.balance);
}

cl::Event VplPasses::reach_open(const cl::CommandQueue& queue, const TransportParams& params,
                                const DeviceScene& scene, const SiteBuffers& b,
                                const WaitList& wait) const {
    need_sites(reach_open_, b);
    need(reach_open_, "chosen", b.chosen,
         last_shooter(params.first_shooter, params.shooter_count) * word);
    need(reach_open_, "balance", b.balance, BALANCE_PLANES * word * b.stride);
    return launch(reach_open_, queue, packets(reach_open_, params.shooter_count), wait, params,
                  static_cast<cl_uint>(scene.info().triangle_count), b.chosen, b.planes,
                  scene.triangles(), scene.positions(), b.balance);
}

cl::Event VplPasses::balance_receivers(const cl::CommandQueue& queue, const ShootParams& params,
                                       const SiteBuffers& b, const cl::Buffer& rows,
                                       const WaitList& wait) const {
    need_sites(balance_receivers_, b);
    need_rows(balance_receivers_, b, rows, 1, 0);
    need(balance_receivers_, "balance", b.balance, BALANCE_PLANES * word * b.stride);
    return launch(balance_receivers_, queue, packets(balance_receivers_, b.site_count), wait,
                  params, b.sites, rows, b.balance);
}

cl::Event VplPasses::balance_shooters(const cl::CommandQueue& queue, const ShootParams& params,
                                      const SiteBuffers& b, const cl::Buffer& rows,
                                      const WaitList& wait) const {
    need_sites(balance_shooters_, b);
    need(balance_shooters_, "chosen", b.chosen,
         last_shooter(params.first_shooter, params.shooter_count) * word);
    need_rows(balance_shooters_, b, rows, params.kept, params.shooter_count);
    need(balance_shooters_, "balance", b.balance, BALANCE_PLANES * word * b.stride);
    return launch(balance_shooters_, queue, params.shooter_count, wait, params, b.chosen, b.sites,
                  rows, b.balance);
}

cl::Event VplPasses::emit(const cl::CommandQueue& queue, const ShootParams& params,
                          const SiteBuffers& b, const cl::Buffer& strongest,
                          const WaitList& wait) const {
    need_sites(emit_, b);
    need(emit_, "strongest", strongest, 4 * word);
    need(emit_, "light", b.light, SITE_LIGHT_PLANES * word * b.stride);
    need(emit_, "power", b.power, word * b.stride);
    need(emit_, "shot", b.shot, 3 * word * b.stride);
    need(emit_, "chosen", b.chosen, last_shooter(params.first_shooter, 1) * word);
    const std::size_t items = params.mode == SHOOT_STRONGEST ? 1 : b.site_count;
    return launch(emit_, queue, items, wait, params, strongest, b.sites, b.planes, b.light, b.power,
                  b.shot, b.chosen);
}

cl::Event VplPasses::shoot(const cl::CommandQueue& queue, const ShootParams& params,
                           const SiteBuffers& b, const cl::Buffer& rows,
                           const cl::Buffer& non_finite, const WaitList& wait) const {
    need_sites(shoot_, b);
    need(shoot_, "chosen", b.chosen,
         last_shooter(params.first_shooter, params.shooter_count) * word);
    need_rows(shoot_, b, rows, params.kept, params.shooter_count);
    need(shoot_, "balance", b.balance, BALANCE_PLANES * word * b.stride);
    need(shoot_, "shot", b.shot, 3 * word * b.stride);
    need(shoot_, "light", b.light, SITE_LIGHT_PLANES * word * b.stride);
    need(shoot_, "power", b.power, word * b.stride);
    need(shoot_, "non_finite", non_finite, word);
    return launch(shoot_, queue, packets(shoot_, b.site_count), wait, params, b.chosen, b.sites,
                  b.planes, rows, b.balance, b.shot, b.light, b.power, non_finite);
}

}  // namespace clgi
