// Ground truth: an independent path tracer on the host, through Embree. It shares no transport
// code with the library; materials follow docs/materials.md, lights KHR_lights_punctual.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/kit/progress.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace clgi::reference {

// Which light paths count. A path of k bounces starts at a light, is reflected by k surfaces and
// then by the visible one: 0 is direct light.
struct Effects {
    static constexpr int unlimited = std::numeric_limits<int>::max();
    bool emission = true;  // visible emissive surfaces and environment
    bool direct = true;    // k = 0
    int first_bounce = 1;  // indirect paths: first_bounce <= k <= last_bounce
    int last_bounce = unlimited;
    bool shadowed = true;        // false: nothing blocks the segment between the last two
                                 // surfaces, as for the VPLs of [Cochran07]; k = 1 only
    bool direct_gloss = true;    // the lobe reflects direct light
    bool indirect_gloss = true;  // and indirect light
};

// From a comma-separated list of: emission, direct, indirect, one-bounce, bounces=K,
// unshadowed-indirect (one bounce, unshadowed), diffuse (no gloss at all), diffuse-indirect.
// "all" or an empty list: everything. Throws Error naming an unknown word, or words that exclude
// each other.
CLGI_API Effects parse_effects(const std::string& list);

// How directions to lights with an extent (emissive surfaces, the environment) are sampled: by the
// light, by the surface's lobes, or both, weighted by the power heuristic. One of them alone is
// noisier and converges to the same picture.
enum class Sampling { both, lights, lobes };

// What of a pixel is looked through: its centre, as a single view of the library does, or all of it
// evenly, as the mean of many samples does (RendererOptions::samples).
enum class Filter { center, box };

struct Options {
    int width = 640;  // pixels
    int height = 480;
    Effects effects;
    // With fewer samples the estimate of the error is not used.
    static constexpr int least_samples = 16;
    int samples = 64;         // per pixel, at most; 1 to 2^24
    double target = 0.0;      // stop at this relative error (below); 0: never
    std::uint64_t seed = 1;   // the same seed gives the same picture with any threads
    int roulette_depth = 4;  // surfaces on a path before Russian roulette may end it
    int threads = 0;          // 0: all
    Sampling sampling = Sampling::both;
    Filter filter = Filter::center;
};

// A place for irradiance(): light atlases, probes, tests.
struct Place {
    glm::dvec3 position;  // metres
    glm::vec3 normal;     // unit
    // Of the surface behind it, unit. Light from below that surface does not count. 0: `normal`.
    glm::vec3 geometric = glm::vec3(0.0f);
};

struct Picture {
    int width = 0;
    int height = 0;
    std::vector<glm::vec3> radiance;  // [height][width] cd/m^2
    std::vector<float> error;         // [height][width] standard error of luminance
    int samples = 0;                  // taken of each pixel
    std::size_t non_finite = 0;       // samples left out; 0 in a healthy run
    double relative_error = 0.0;      // root of the mean squared standard error, over the mean
    double seconds = 0.0;
    bool cancelled = false;
};

struct Irradiance {
    std::vector<glm::vec3> values;  // lux
    std::vector<float> error;       // standard error of luminance
    int samples = 0;
    std::size_t non_finite = 0;   // samples left out
    double relative_error = 0.0;  // root of the mean squared standard error, over the mean
    double seconds = 0.0;
    bool cancelled = false;
};

// A number with its 95 % confidence interval. high is infinite where the samples set no limit.
struct Estimate {
    double value = 0.0;
    double low = 0.0;
    double high = 0.0;
};

struct VerifyOptions {
    Effects effects;         // of the truth
    Filter filter = Filter::center;  // of pixels
    double seconds = 0.0;    // time limit; 0: none. A first pass and 200 pixels take what they take
    // > 0: ends when the interval lies above this error, or below it, at two looks in a row, the
    // second after twice as many samples.
    double decide = 0.0;
    int pixels = 1000;       // that are path-traced, at most; 16 to 2^20
    int samples = 64;        // paths of one of them, at most, as a mean of all; 8 to 2^20
    std::uint64_t seed = 1;  // without a time limit the same seed gives the same result
    int threads = 0;         // 0: all
};

// A pixel that was path-traced, by luminance.
struct CheckedPixel {
    std::size_t column = 0;  // of places their number
    std::size_t row = 0;
    // Of the squared error that was found, in which it stands for others; above 1 where noise makes
    // others negative.
    double share = 0.0;
    double picture = 0.0;
    double truth = 0.0;      // the mean of its paths
    double deviation = 0.0;  // standard error of that mean
};

// How far a picture is from the truth, by a few path-traced pixels (docs/reference.md).
struct Verification {
    // Root of the mean squared difference of luminance over the mean luminance of the truth; the
    // noise of the path tracer is not part of it.
    Estimate error;
    Estimate energy;                    // mean luminance of the picture over that of the truth
    std::vector<CheckedPixel> largest;  // at most 8, by falling share; none if the error found is 0
    int pixels = 0;                     // that were path-traced, those of the first pass included
    std::uint64_t samples = 0;          // paths, of all of them
    std::size_t non_finite = 0;         // samples left out
    double seconds = 0.0;
    bool cancelled = false;  // error and energy are not set
};

class CLGI_API PathTracer {
public:
    // Validates and copies what it needs. Throws InputError for a broken scene.
    explicit PathTracer(const Scene& scene);
    ~PathTracer();

    // Throws Error for options out of range.
    Picture render(const Camera& camera, const Options& options,
                   const Progress& progress = nullptr) const;

    // The irradiance at places, cosine included. width and height are ignored.
    Irradiance irradiance(const std::vector<Place>& places, const Options& options,
                          const Progress& progress = nullptr) const;

    // How far radiance, [height][width] cd/m^2, is from what this path tracer finds for the camera.
    // Throws Error for options out of range, a picture of another size, and pixels that are not
    // finite.
    Verification verify(const Camera& camera, int width, int height,
                        const std::vector<glm::vec3>& radiance, const VerifyOptions& options,
                        const Progress& progress = nullptr) const;

    // The same of irradiance at places, [places] lux. Effects::emission is not read.
    Verification verify(const std::vector<Place>& places, const std::vector<glm::vec3>& irradiance,
                        const VerifyOptions& options, const Progress& progress = nullptr) const;

    // Transfer vectors of diffuse places [places][bands^2], sr: what of the light from everywhere
    // arrives, cosine included, in spherical harmonics of the world's frame (clgi/advanced/sh.hpp).
    // Rays in strata x strata directions, jittered in strata of equal cosine. Triangles that touch
    // a place do not block: it sees them edge-on. Place::geometric is not read. Throws Error for
    // bands and strata out of range.
    std::vector<double> transfer(const std::vector<Place>& places, int bands, int strata = 64,
                                 std::uint64_t seed = 1) const;

private:
    struct World;
    std::unique_ptr<World> world_;
};

}  // namespace clgi::reference
