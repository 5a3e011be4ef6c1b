// What the light atlas solver is made of.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_blocks.hpp>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/advanced/kit/emitters.hpp>
#include <clgi/light_atlas.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/lights.hpp>
#include <clgi/passes/parallel.hpp>

namespace clgi {

namespace light_atlas {

struct Buffers {
    SiteBuffers sites;
    GBuffer samples, texels;             // of sample points and VPLs, of texels
    cl::Buffer sample_list, texel_list;  // SurfaceSample
    cl::Buffer sample_irradiance;        // [IRRADIANCE_PLANES][sample_stride]
    cl::Buffer gathered, irradiance;     // [IRRADIANCE_PLANES][texel_stride]; the second completed
    cl::Buffer reach, filled;            // [texel_stride]
    cl::Buffer seen;                     // [rows][texel_stride] uchar, atlas.see
    BlockBuffers blocks;                 // where texels are refined
    GBuffer listed;                      // of texels that are looked up first
    cl::Buffer listed_texels;            // SurfaceSample
    cl::Buffer list_scratch;             // of the list of VPLs that send
    cl::Buffer rows;                     // transport, half
    cl::Buffer strongest, arg_max_scratch;
    cl::Buffer views, pixels;  // hemicubes of a batch
    MeshBuffers mesh;          // for Filling::project
    cl::Buffer non_finite;
    RasterBuffers lists;  // for what is not drawn a view a work-item
    std::uint32_t texel_count = 0, texel_stride = 0;
    std::uint32_t first_point = 0;     // behind the texels, at the beginning of a packet
    std::uint32_t receiver_count = 0;  // texels, and all up to the last point if there are points
    std::uint32_t batch = 0;           // shooters at a time
    std::uint32_t listed_count = 0, listed_stride = 0, unblocked = 0;  // as in BlockParams
    std::uint32_t block_count = 0;                                     // 0: nothing is refined
    bool kept = false;                                                 // rows of all sites
    bool seen_kept = false;  // what texels see of them; only if the rows are kept
};

// Throws Error for options out of range.
void check(const LightAtlasOptions& options);

// Throws Error for more VPLs, sample points, texels and points than kernels count: planes of them
// have at most 2^32 numbers.
void check_sizes(std::size_t vpls, std::size_t samples, std::size_t texels, std::size_t points);

// Throws Error for points that are not finite, and for a filling that has none.
void check_points(const std::vector<BakePoint>& points, const LightAtlasOptions& options);

// Pixels of the shadow maps of spots and directional lights, where nothing else is asked for.
int usual_shadow_size(const DeviceScene& scene, const EmitterOptions& emitters);

// Squares across a face of a mesh of so many triangles.
std::uint32_t mesh_squares(int triangles);

// What the filling reads of hemicubes, where it draws them.
inline Pixels filling_pixels(const LightAtlasOptions& options) {
    return options.filling == Filling::project ? Pixels::visibility : Pixels::depth;
}

// The row of every buffer. `budget`: bytes for all, from which it follows what is kept.
BufferTable table(Buffers& buffers, Emitters& emitters, const DeviceScene& scene,
                  const VplLayout& vpls, const AtlasLayout& atlas, std::size_t points,
                  const AtlasBlocks& blocks, const LightAtlasOptions& options, bool grouped,
                  std::size_t budget, std::size_t largest);

}  // namespace light_atlas

struct LightAtlasSolver::State {
    State(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& scene,
          const VplLayout& vpls, const AtlasLayout& atlas, const LightAtlasOptions& options,
          const std::vector<BakePoint>& points);

    void build();
    void upload(const VplLayout& vpls, const AtlasLayout& atlas, const AtlasBlocks& blocks);
    void place();
    void place_points();
    void receive_direct();
    void light_points(const GBuffer& points, std::uint32_t count, const cl::Buffer& irradiance,
                      bool add);
    void hemicubes(std::uint32_t first, std::uint32_t count, Pixels kind);
    void transport(std::uint32_t first, std::uint32_t count);
    void see(std::uint32_t first, std::uint32_t count);
    void see_all(std::uint32_t first, std::uint32_t count, std::uint32_t first_texel);
    void upload_blocks(const AtlasBlocks& blocks, const std::vector<SurfaceSample>& texels);
    void place_blocks();
    void see_in_blocks(std::uint32_t first, std::uint32_t count);
    BlockParams block_params(std::uint32_t first, std::uint32_t count) const;
    void measure();
    void balance();
    void balance_shooters(std::uint32_t first, std::uint32_t count);
    void shoot(std::uint32_t first, std::uint32_t count);
    void bounce();
    void bounce_to_threshold();
    void shoot_strongest();
    void exchange();
    void send(float least);
    void find_reach();
    void leave_points();
    void fill();
    std::vector<float> light_of_texels() const;
    void note_brightest();
    bool residue_shows();
    void clear_texels();
    void send_anew();
    void put_back_measurement();
    void put_back_light();
    void gather(std::uint32_t first, std::uint32_t count);
    void upload_charts(const AtlasLayout& atlas, const std::vector<std::uint32_t>& device);
    void project(std::uint32_t first, std::uint32_t count);
    FillParams fill_params(std::uint32_t first, std::uint32_t count) const;
    ShootParams shoot_params(std::uint32_t first, std::uint32_t count) const;
    double unshot_power() const;  // exposed
    float strongest_power();      // exposed; waits
    bool run(const Progress& progress, double least);

    cl::CommandQueue queue;
    const DeviceScene& scene;
    LightAtlasOptions options;
    GBufferPasses gbuffer;
    LightPasses lights;
    VplPasses vpl;
    AtlasPasses atlas;
    ParallelPasses parallel;
    Emitters emitters;
    light_atlas::Buffers b;
    mutable Recorder record;
    float row_scale = 1.0f;  // area of all sites, local
    float lift = 0.0f;
    double power_direct = 0.0;  // exposed
    float threshold = 0.0f;     // exposed lumen
    std::uint32_t shots = 0;
    std::size_t bytes = 0;
    bool placed = false, measured = false, near_known = false, ended = false;
    bool differences = false;  // this run adds to what the texels have
    std::uint32_t measured_vpls = 0;
    std::uint32_t filled_vpls = 0;  // that have lit the texels in this run
    std::optional<LightAtlasState> restored;
    std::vector<Site> sites;
    std::vector<BakePoint> bake_points;
    // [receiver_count] exposed lux of the brightest channel that each texel was ever given since
    // all light was sent; empty: what it has now
    std::vector<float> brightest;
    std::vector<float> direct;  // irradiance of the sites by direct light, [3][stride]
};

}  // namespace clgi
