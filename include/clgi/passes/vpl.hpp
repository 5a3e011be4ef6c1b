// VPLs spread over the surface and the light that they exchange, one method per kernel. Structs:
// clgi/shared/vpl.h. Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/vpl.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>

namespace clgi {

// The sites of a layout on the device, and their light. Planes are float in every storage.
struct SiteBuffers {
    cl::Buffer sites;    // [site_count] Site
    cl::Buffer planes;   // [SITE_PLANES][stride]
    cl::Buffer light;    // [SITE_LIGHT_PLANES][stride] exposed lux
    cl::Buffer balance;  // [BALANCE_PLANES][stride]
    cl::Buffer power;    // [stride] unshot power, exposed lumen; channels summed
    cl::Buffer shot;     // [3][stride] power on its way, exposed lumen
    cl::Buffer samples;  // [GBUFFER_PLANES][sample_stride] of the sample points, then of the sites
    cl::Buffer points;   // [SITE_POINT_PLANES][point_stride] of the samples that are looked at
    cl::Buffer chosen;   // uint: sites in the order in which they shoot
    // What texels receive of them; exposed lumen.
    cl::Buffer sent;          // [3][sample_stride] what samples sent so far
    cl::Buffer sample_power;  // [3][sample_stride] what they send now
    cl::Buffer site_power;    // [3][stride] the same of their sites
    cl::Buffer sends;         // [site_count] uchar, 1: the site sends something
    cl::Buffer list;          // [site_count] uint: sites that send
    cl::Buffer listed;        // [1] uint: how many they are
    std::uint32_t site_count = 0;
    std::uint32_t stride = 0;
    std::uint32_t sample_count = 0;
    std::uint32_t sample_stride = 0;
    std::uint32_t most_samples = 0;  // of a site that are looked at, at least 1
    std::uint32_t per_site = 0;      // points_per_site(most_samples)
    std::uint32_t point_stride = 0;  // plane_stride(site_count * per_site)
};

// Places for the points of a site: a power of two below a packet of 16, or a multiple of that.
constexpr std::uint32_t points_per_site(std::uint32_t most_samples) {
    if (most_samples > 8) return (most_samples + 15) / 16 * 16;
    return most_samples > 4 ? 8 : most_samples > 2 ? 4 : most_samples;
}

class CLGI_API VplPasses {
public:
    explicit VplPasses(const Programs& programs, const BuildOptions& options = {});
    VplPasses(const cl::Context& context, const cl::Device& device,
              const BuildOptions& options = {})
        : VplPasses(Programs(context, device), options) {}

    // Planes of the sites from those of their samples. ids: [GBUFFER_ID_PLANES][sample_stride] int.
    cl::Event place(const cl::CommandQueue& queue, const DeviceScene& scene,
                    const SiteBuffers& buffers, const cl::Buffer& ids,
                    const WaitList& wait = {}) const;

    // Points of the sites from those of their samples, as they are placed.
    cl::Event points(const cl::CommandQueue& queue, const SiteBuffers& buffers,
                     const WaitList& wait = {}) const;

    // Direct light: irradiance [IRRADIANCE_PLANES][sample_stride] of the samples -> light.
    cl::Event receive(const cl::CommandQueue& queue, const SiteBuffers& buffers,
                      const cl::Buffer& irradiance, const WaitList& wait = {}) const;

    // What the sites send to the texels beyond what they have sent, shared among their sample
    // points by their own direct light and reflectance -> sent, sample_power, site_power, sends.
    // irradiance: as for receive. least: the smallest change of a site's power that is sent,
    // exposed lumen; below 0: every site sends.
    cl::Event send(const cl::CommandQueue& queue, const SiteBuffers& buffers,
                   const cl::Buffer& irradiance, float least, const WaitList& wait = {}) const;

    // Rows of the transport of a batch of shooters. views, depth: their hemicubes.
    // rows: [site_count or shooter_count][stride] half.
    cl::Event transport(const cl::CommandQueue& queue, const TransportParams& params,
                        const SiteBuffers& buffers, const cl::Buffer& views,
                        const cl::Buffer& depth, const cl::Buffer& rows,
                        const WaitList& wait = {}) const;

    // The same where nothing lies between surfaces, without hemicubes; params.size is not used.
    cl::Event transport_open(const cl::CommandQueue& queue, const TransportParams& params,
                             const SiteBuffers& buffers, const cl::Buffer& rows,
                             const WaitList& wait = {}) const;

    // BALANCE_REACH of a batch of shooters. views, depth: their hemicubes.
    cl::Event reach(const cl::CommandQueue& queue, const TransportParams& params,
                    const SiteBuffers& buffers, const cl::Buffer& views, const cl::Buffer& depth,
                    const WaitList& wait = {}) const;

    // The same where nothing lies between surfaces, from the scene's triangles.
    cl::Event reach_open(const cl::CommandQueue& queue, const TransportParams& params,
                         const DeviceScene& scene, const SiteBuffers& buffers,
                         const WaitList& wait = {}) const;

    // BALANCE_RECEIVER of all sites; rows of all.
    cl::Event balance_receivers(const cl::CommandQueue& queue, const ShootParams& params,
                                const SiteBuffers& buffers, const cl::Buffer& rows,
                                const WaitList& wait = {}) const;

    // BALANCE_SHOOTER of a batch of shooters.
    cl::Event balance_shooters(const cl::CommandQueue& queue, const ShootParams& params,
                               const SiteBuffers& buffers, const cl::Buffer& rows,
                               const WaitList& wait = {}) const;

    // Takes the unshot light of all sites, or of the strongest, and makes it power on its way.
    // strongest: [1] ArgMax of the power; with SHOOT_STRONGEST also the new
    // chosen[first_shooter].
    cl::Event emit(const cl::CommandQueue& queue, const ShootParams& params,
                   const SiteBuffers& buffers, const cl::Buffer& strongest,
                   const WaitList& wait = {}) const;

    // The power of a batch of shooters arrives at all sites. non_finite: [1] uint, counts packets.
    cl::Event shoot(const cl::CommandQueue& queue, const ShootParams& params,
                    const SiteBuffers& buffers, const cl::Buffer& rows,
                    const cl::Buffer& non_finite, const WaitList& wait = {}) const;

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    PassKernel place_, points_, receive_, transport_, transport_open_, reach_, reach_open_,
        balance_receivers_, balance_shooters_, emit_, shoot_, send_;
};

}  // namespace clgi
