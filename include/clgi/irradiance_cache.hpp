// Irradiance cache: light of the sky, of emissive surfaces and of all bounces, gathered by
// hemicubes at places that the picture needs.                      [Ward88; derived: hemicubes]
//
// The other methods look at the scene; this one looks at what the picture sees, and at what that
// sees in turn. So light that comes through a window, from a far wall or out of a terrain a
// thousand times larger than the room costs what it weighs in the picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/kit/picture.hpp>
#include <clgi/advanced/solver_status.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/programs.hpp>
#include <memory>

namespace clgi {

struct IrradianceCacheOptions {
    int seen = 400;  // records on what the picture shows, about; 1 to 20000
    int met = 1200;  // records on what these see, and what those see in turn; 0 to 20000
    // Records more where reflected light changes between those that are seen; 0 to 20000.
    int refined = 300;
    int face = 32;    // pixels, side of a hemicube's face; a multiple of 8, 8 to 256
    int bounces = 0;  // reflections of light before it reaches a record; 0: until it rests
    // VPLs, at most, in what lights light of small places, as the sun does behind a hole, which
    // would fall between the pixels of hemicubes; 0 to 1024. Of at most 32 views of lights:
    // directional lights have one, then come spots, then point lights with six.
    int spots = 128;
    // Directions of the sky that each sample of a picture but the first takes, with shadow maps,
    // for light of the sky between records; 0 to 4096. 0, or a picture of one sample: by hemicubes
    // alone.
    int sky_lights = 32;
    // true: emissive surfaces light by hemicubes, as lamps of any shape and number do best; false:
    // those within the scene's focus by points with shadow maps (EmitterOptions::area_samples),
    // whose shadows are sharper.
    bool emission = false;
    // But environment_lights: the sky lights by hemicubes. build.storage is full. Where
    // emitters.area_size is 0 it is area_face(emitters.face_size).
    PictureOptions picture;

    // Side of hemicubes as they are drawn, pixels. Where there is a sky, small faces are drawn
    // twice as large: it is looked at in all pixels, so that windows and what is bright in it do
    // not fall between them, and surfaces, which take longer, in every other column and row. Not
    // where the scene has so many triangles that drawing takes most of the time.
    int drawn_face(bool sky, double triangles) const {
        return sky && face <= 24 && triangles <= 65536.0 ? 2 * face : face;
    }
    // Side of the faces of shadow maps of points on emissive surfaces, pixels, where point lights
    // have so many. Each point has a part of a lamp's light, so its shadows need not be as sharp.
    static int area_face(int face_size) { return face_size / 2 + face_size % 2; }
    // How many points on emissive surfaces light a pixel of a hemicube, in turns: in finer ones
    // there are more pixels for each point.
    static constexpr int most_at_once = 4;
    int samples_at_once() const { return std::clamp(64 / std::max(face, 1), 1, most_at_once); }
    // Of what records bring each other, the largest buffer, at most: blocks of pixels have up to
    // four records, and refined ones bring others nothing.
    double transport_bytes() const {
        const double others = 4.0 * seen + met;
        return 12.0 * (others + refined) * others;
    }
};

// converged: the last reflection changed the light at no record by more than a thousandth of the
// brightest.
struct IrradianceCacheStatus : SolverStatus {
    std::size_t seen = 0, met = 0, refined = 0;  // records
    std::size_t spots = 0;                       // VPLs in small lit places
    int bounces = 0;                             // reflections that were made
};

// What a picture will allocate, without the picture's own buffers, and take, both about, before any
// of it is made.
CLGI_API Estimate estimate(const cl::Device& device, const DeviceScene& scene,
                           const IrradianceCacheOptions& options);

// Owns its buffers, works on the given queue (in order or not). The scene must outlive this object.
// One thread at a time.
class CLGI_API IrradianceCache {
public:
    // Builds kernels and allocates. Throws Error for options out of range, DeviceError when memory
    // does not suffice.
    IrradianceCache(const Programs& programs, const cl::CommandQueue& queue,
                    const DeviceScene& scene, const IrradianceCacheOptions& options = {});
    ~IrradianceCache();
    IrradianceCache(const IrradianceCache&) = delete;
    IrradianceCache& operator=(const IrradianceCache&) = delete;

    // Reads the scene's lights and environment again.
    void lights_changed();

    // A picture that begins after `wait`. Waits for its own records, because the host chooses them;
    // the event completes when all of the picture has.
    cl::Event render(const Camera& camera, const WaitList& wait = {});
    // Another picture by the records of the last one, which are nearly the same for a camera that
    // looks from the same place through other points of its pixels. Throws Error before render().
    cl::Event render_again(const Camera& camera, const WaitList& wait = {});
    // Picture::sample(): of direct light, the sky and lobes; records keep what they have. Indices
    // rise from 0 on.
    void sample(std::uint32_t index);

    IrradianceCacheStatus status() const;  // of the last picture; waits
    // Of the last picture, what records leave in doubt: by how much those that a pixel is lit by
    // differ, in what the pixel reflects of them; root of the mean square over the mean luminance.
    // Errors of indirect light were 0.3 to 1.4 times as large, in scenes where they were 2 to 57 %
    // (docs/results/irradiance-cache.md), but no record knows of light that none has met. Waits.
    double doubt() const;
    const Picture& picture() const;
    const std::vector<PassEvent>& events() const { return picture().events(); }
    const IrradianceCacheOptions& options() const;
    std::size_t bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
