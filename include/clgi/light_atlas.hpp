// Light atlas: multi-bounce diffuse light, exchanged between VPLs with visibility and gathered into
// the texels of an atlas.                                                     [Schaerfig16]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/emitters.hpp>
#include <clgi/advanced/interval.hpp>
#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/advanced/occlusion.hpp>
#include <clgi/advanced/solver_status.hpp>
#include <clgi/advanced/vpl_layout.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/atlas.hpp>
#include <clgi/passes/vpl.hpp>
#include <clgi/programs.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace clgi {

// How the VPLs' light reaches the texels.
enum class Filling {
    gather,   // every texel looks up every VPL's depth maps
    project,  // triangles of a mesh M over each VPL's view are projected into the atlas [section 4]
};

// Those of a bake, which draws shadow maps once: size 0.
inline EmitterOptions bake_emitters() {
    EmitterOptions out;
    out.shadow_size = 0;
    return out;
}

struct LightAtlasOptions {
    // Shadow maps and samples of the lights; emitters.vpls is not used. shadow_size 0: 2048 pixels,
    // 1024 or 512 where more than 4 or 16 lights have such a map: directions, and spots of at most
    // 60 degrees from the axis.
    EmitterOptions emitters = bake_emitters();
    // How often light is reflected at most before it reaches a texel, at least 1; 0: until the
    // largest unshot power is below the threshold.
    std::uint32_t bounces = 0;
    float threshold = 1e-3f;  // of the mean power that direct light makes VPLs reflect, [1e-7,1]
    // With bounces = 0: the strongest VPL shoots alone, then the next, as in the paper. Otherwise
    // all shoot at once, which converges to the same light in far less time.
    bool one_at_a_time = false;
    // Sample points of a receiving VPL that are looked at when VPLs exchange light; 0: 25,600
    // divided by the number of VPLs, but 4 to 16, if the VPL has as many. So a shooter looks at
    // 25,600 in all between 1,600 and 6,400 VPLs, at fewer below and at more above. All of them
    // send light to the texels near by.
    std::uint32_t exchange_samples = 0;
    // none: nothing lies between two surfaces. VPLs and texels that face each other then see each
    // other, and no hemicube is drawn; hemicube_size and refine are not used, and Filling::project,
    // which projects hemicubes, is an error.
    Occlusion occlusion = Occlusion::automatic;
    int hemicube_size = 256;  // pixels of the face of a VPL's hemicube, even
    Filling filling = Filling::gather;
    // For Filling::gather: texels between those that are looked up first, 1, 2 or 4. Blocks of 4 x
    // 4 texels take over whom their corners see where these agree [section 6.2]; 1: every texel
    // looks up every VPL.
    int refine = 2;
    int mesh = 512;  // triangles of M over a hemicube's face, for Filling::project: 2 n^2 with an
                     // even n of at most hemicube_size, 8 to 131072
    int kernel = 5;  // K, its soft shadows: pixels to each side, 0 (hard) to 64
    bool direct = false;  // direct light in the texels too; points never have it
    // Bytes that the solver's buffers may take together; 0: what the device has beside the scene.
    // The transport between all pairs of VPLs is kept if it fits, else computed anew each bounce;
    // then which texels each VPL sees, else the scene is drawn again to fill the atlas.
    std::size_t memory_budget = 0;
    BuildOptions build;  // storage is full: texels are sums of thousands of VPLs
};

// What a bake found out. Power is in lumen, the three channels summed.
// converged: what VPLs have not shot is at most the threshold's share of direct light.
struct LightAtlasStatus : SolverStatus {
    std::uint32_t shots = 0;  // VPLs that shot, counted at every bounce
    std::uint32_t sent = 0;   // VPLs that sent light to the texels in the last run
    bool transport_kept = false;
    bool visibility_kept = false;  // which texels each VPL sees; without occlusion there is nothing
                                   // to keep
    double power_direct = 0.0;     // that all VPLs reflect of direct light
    double power_shot = 0.0;       // by all VPLs together
    double power_received = 0.0;   // by all VPLs, of what was shot
    double power_lost = 0.0;       // that left the scene or ended on backs of surfaces
    double power_left = 0.0;       // not shot
};

// A bake that was cancelled, as plain data: what was measured, or, where that is not kept, the
// light. Light is exposed. It belongs to one scene, its layouts, its points and its options; the
// same device carries it on to the same bits.
struct LightAtlasState {
    std::uint32_t vpls = 0;
    std::uint32_t texels = 0;         // and points
    std::uint32_t measured_vpls = 0;  // the first so many have their rows, seen and balance
    std::uint32_t filled_vpls = 0;    // or: the first so many have lit the texels
    std::uint32_t shots = 0;          // as in LightAtlasStatus
    std::vector<std::uint16_t> rows;  // [measured_vpls][stride of VPLs] half
    std::vector<std::uint8_t> seen;   // [seen_rows(measured_vpls)][stride of texels]
    std::vector<float> balance;       // [BALANCE_PLANES][stride of VPLs]
    std::vector<float> light;         // [SITE_LIGHT_PLANES][stride of VPLs]
    std::vector<float> irradiance;    // [3][stride of texels]
    std::vector<float> filled;        // [stride of texels] sums of form factors
};

// Bytes that a solver's buffers take at the least, beside those for the texels.
CLGI_API std::size_t light_atlas_least_bytes(std::size_t vpls, std::size_t samples);

// Throws DeviceError if so many VPLs cannot be baked at all: what to check before they are placed,
// which takes long, and memory of its own.
CLGI_API void check_bake_fits(const cl::Device& device, const VplOptions& vpls);

// What a bake with all that precedes it will allocate and take, both about, before anything is laid
// out: pages are taken for three quarters full.
CLGI_API Estimate estimate(const cl::Device& device, const DeviceScene& scene,
                           const VplOptions& vpls, const AtlasOptions& atlas,
                           const LightAtlasOptions& options = {});

// Owns its buffers, works on the given queue (in order or not), never finishes it. The scene must
// outlive the solver; the layouts are not needed afterwards. One thread at a time.
class CLGI_API LightAtlasSolver {
public:
    // Builds kernels and allocates. vpls, atlas: of the scene that was uploaded. points: where
    // indirect light is baked beside the texels, with Filling::gather alone. Throws Error for
    // options out of range, layouts of another scene and points that are not finite, DeviceError
    // when memory does not suffice.
    LightAtlasSolver(const Programs& programs, const cl::CommandQueue& queue,
                     const DeviceScene& scene, const VplLayout& vpls, const AtlasLayout& atlas,
                     const LightAtlasOptions& options = {},
                     const std::vector<BakePoint>& points = {});
    ~LightAtlasSolver();
    LightAtlasSolver(const LightAtlasSolver&) = delete;
    LightAtlasSolver& operator=(const LightAtlasSolver&) = delete;

    // Reads the scene's lights again, after DeviceScene::set_light. The next run keeps the
    // transport and what texels see: direct light, the exchange and the filling are computed anew,
    // and nothing is drawn but shadow maps.
    void lights_changed();

    // Bakes, and waits for the end. Returns whether it was not cancelled; a cancelled bake may be
    // run again.
    bool run(const Progress& progress = nullptr);

    // Bakes for lights that changed since the last run. Light is exchanged anew; then only VPLs
    // whose sample points' powers changed by more than `least` together, in mean powers of direct
    // light that VPLs reflect, send the difference to the texels [section 6.2]. What is not sent is
    // not lost: it counts in the next update. Bakes as run() does where no run has ended before, or
    // where what texels see would have to be drawn again. Where light fell so far that the rounding
    // of what was taken away would show in one texel of a thousand, all VPLs send anew. Throws
    // Error for a `least` that is negative or no number.
    bool update(double least = 1e-3, const Progress& progress = nullptr);

    // What the last run left behind when it was cancelled; empty if it ended, or was cancelled
    // before there was anything to keep. Waits.
    std::optional<LightAtlasState> state() const;

    // The next run goes on from there. Throws Error for the state of a bake of another size.
    void restore(const LightAtlasState& state);

    // Waits for the last run and reads what it found.
    LightAtlasStatus status() const;

    // Irradiance of each texel of AtlasLayout::texels, lux. Waits.
    std::vector<glm::vec3> irradiance() const;
    // Irradiance of each point, lux, without direct light. Waits.
    std::vector<glm::vec3> point_irradiance() const;
    // Irradiance of each VPL, lux, without cosine to a texel: what its surface receives. Waits.
    std::vector<glm::vec3> vpl_irradiance() const;

    // [3][stride()] float, exposed lux, by texel; by point from
    // first_bake_point(AtlasLayout::texels.size()) on.
    const cl::Buffer& irradiance_planes() const;
    std::uint32_t stride() const;
    const cl::Buffer& texel_planes() const;  // a G-buffer's planes, [GBUFFER_PLANES][stride()]
    const SiteBuffers& sites() const;
    std::size_t bytes() const;  // of all buffers
    const std::vector<PassEvent>& events() const;
    Interval interval() const;  // of the last run, on the queue
    const LightAtlasOptions& options() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
