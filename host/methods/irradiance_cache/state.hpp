// What an irradiance cache owns, and the steps of its picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/emitters.hpp>
#include <clgi/irradiance_cache.hpp>
#include <clgi/passes/cache.hpp>
#include <clgi/passes/lights.hpp>
#include <cstddef>
#include <memory>
#include <vector>

#include "methods/irradiance_cache/coarse_sky.hpp"
#include "methods/irradiance_cache/correction_totals.hpp"
#include "methods/irradiance_cache/records.hpp"

namespace clgi {

constexpr std::uint32_t picks_per_record = 16;
constexpr std::size_t scattered = 64;  // VPLs that others light, at most, of each reflection

// VPLs in small lit places, with those that others light; 0 without.
std::size_t most_vpls(const IrradianceCacheOptions& options);

// Of the directions of the sky that light the pixels of a sample.
EmitterOptions sky_options(const IrradianceCacheOptions& options, std::uint32_t sample);

// What hemicubes see of the sky: all that is not lit by as lamps do.
SkyPart soft_sky(const IrradianceCacheOptions& options);

// Of lights' views and of finer hemicubes, drawn to find such places.
std::size_t spot_pixels(const EmitterOptions& emitters);

struct IrradianceCache::State {
    State(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& of,
          const IrradianceCacheOptions& wanted);
    void add_to(BufferTable& table);
    // Reads whole planes, waiting.
    std::vector<CacheRecord> read_records(const cl::Buffer& planes, std::size_t plane_floats,
                                          std::size_t count);
    void write_records();
    // The scene as records from `first` on see it.
    void draw(std::size_t first);
    // Hemicubes of `count` places from `first` on; chosen: which of those that planes have.
    struct Hemicubes {
        const cl::Buffer &planes, &chosen, &views, &visibility;
        std::uint32_t stride, face;
        std::size_t first, count;
    };
    void draw_cubes(const Hemicubes& of);
    CacheParams params(std::size_t first, std::size_t count) const;
    // So many points on emissive surfaces light what a block shows.
    static void take_turns(CacheParams& params, int at_once);
    // What the records from `first` on see becomes up to `count` more records.
    void meet(std::size_t first, std::size_t count);
    void choose(const View& view);
    // A tree of all records, for one of two uses; the last is that of the picture.
    void plant(CacheTree& of, cl::Buffer& nodes, cl::Buffer& lists);
    // More records where others see light that is in doubt and that reaches the picture.
    void weigh(std::size_t count);
    // The transport of the records from `first` on, from those that light goes between, by one
    // block of pixels in `thin`.
    void link(std::size_t first, std::uint32_t thin = 1);
    // How many nodes a tree has is known when it is made.
    void grow(cl::Buffer& buffer, std::size_t size);
    // Until the light rests, or so many reflections.
    void light(int limit);
    void bounce(std::size_t first);
    // More records where reflected light changes between those that are there, in rounds of ever
    // smaller blocks. They gather what the last reflection did for the others, which have no light
    // of theirs.
    void refine(const View& view);
    // Waits. `count` floats from `first` on.
    std::vector<float> read_planes(const cl::Buffer& from, std::size_t first, std::size_t count);
    std::vector<float> read_doubt();  // of what pixels reflect
    double doubted();                 // of the picture that was shown last
    // Whether the last step changed little.
    bool rests();
    // Of the records that pixels look up.
    const CacheTree& shown_tree() const { return found.refined > 0 ? all_tree : tree; }
    CacheBuffers shown_buffers() const;  // with the light that show() made of it
    // sky: light_by_sky() has been called.
    void show(bool sky = false);
    // Where the scene has a sky and options ask for its directions: light of the sky between the
    // records, by shadow maps of `sample`, other ones than those of samples before it but for some
    // in fine scenes.
    // show_by_sky() shows the light of the records and corrects it, unless none of them sees the
    // sky: draw_sky() draws directions, and false says so. correct() finds what a part of them
    // brings to the records, interpolates that, and finds what it brings to the pixels.
    struct Part {
        std::uint32_t first, count;
    };
    void show_by_sky();
    bool draw_sky();
    // Whether emitters stand for many bright directions of the sky, which are drawn where the
    // records see it as soon as there are some.
    bool aims() const { return sky.parts > 1 && corrects(); }
    void aim_lights();
    void weigh_sky_once();
    void correct(const Part& part);
    // The light that is shown of records, as far as directions of the sky know it better than their
    // hemicubes; where these see no lamps.
    bool settles() const;
    void settle();
    // Where surfaces have lobes: what the records have around them, and what lobes reflect of it.
    void look_around();
    void add_gloss(const View& view);
    // Whether some are so smooth that they are followed by rays.
    bool follows_lobes() const;
    void read_sky();
    bool corrects() const { return sky_lights.casts_shadows(); }
    void forget_corrections();
    std::shared_ptr<const SkyWeights> weigh_sky();
    LocalBox lit_by_sky();  // around what is shown and the records that stand in for it
    void light_by_sky(const Part& part, const cl::Buffer& planes, std::size_t points,
                      std::uint32_t of_stride, const cl::Buffer& irradiance, std::uint32_t add);
    // Rows of the buffers for VPLs in small lit places; finds these places, as the records see
    // them.
    void add_spots(BufferTable& table);
    void find_spots(bool finely);
    bool casts_spots() const;
    struct SpotTally {
        std::vector<std::uint32_t> count;
        std::vector<float> area;
    };
    SpotTally tally_spots(const std::vector<SpotView>& of, std::vector<View>& views,
                          const std::vector<std::uint32_t>& tiles);
    void write_tiles(const std::vector<std::uint32_t>& tiles);
    void mark_sides(bool finely);  // that records see
    void draw_hemicubes(const std::vector<Vpl>& vpls, std::size_t first);
    void scatter_spots(std::size_t most);

    const DeviceScene& scene;
    IrradianceCacheOptions options;
    int drawn;  // side of a face of records' hemicubes, pixels; options.face or twice that
    Picture picture;
    CachePasses passes;
    GBufferPasses cubes;
    CacheBuffers b;
    SpotBuffers spot;
    SpotParams spots{};
    bool has_tiles = false;         // of lights that do not light pixels
    std::uint32_t spot_size = 0;    // pixels a side
    std::uint32_t spot_stride = 0;  // of the planes of VPLs
    CacheAround surroundings{};
    CacheTree tree{}, all_tree{};  // of those that light goes between, of these and refined ones
    RecordTree planted;            // the last of them
    CoarseSky sky, mirrored;
    Emitters sky_lights;
    LightPasses lights;
    cl::Buffer around, mirrored_sky, sight, found_light, corrections, shares;
    cl::Buffer settled, settled_sums;
    cl::Buffer sharp_light, sharp_shown, sharp_sky;  // as hemicubes and pixels look it up
    bool weighed = false;  // whether the records of this picture see the sky is known
    std::shared_ptr<const SkyWeights> sky_weights;  // by these records; null: they do not
    LocalBox receivers{};                           // of light of the sky
    std::size_t grown = 0;                          // bytes, of shadow maps, trees and lists
    std::uint32_t sample = 0;
    CacheCorrectParams gauged{};             // the last of them
    std::uint32_t sky_set = 0;               // which directions are drawn
    CorrectionTotals of_pixels, of_records;  // records take each set of directions once
    cl::Buffer all_nodes, all_lists;         // of all_tree
    CachePasses::Crowds crowds;              // of planted
    cl::Buffer chosen, places, worth, nearest, doubt;
    std::vector<CacheRecord> records;
    std::vector<CacheRecord> shown;  // what each pixel shows
    std::size_t capacity = 0, pick_stride = 0;
    std::uint32_t stride = 0;
    std::uint32_t row_stride = 0;  // of the transport: refined records light no others
    IrradianceCacheStatus found;
};

}  // namespace clgi
