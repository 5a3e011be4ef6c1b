// Checks of pictures and of places.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <cmath>

#include "reference/sampled_light.hpp"
#include "reference/verifier.hpp"
#include "reference/world.hpp"

namespace clgi::reference {
namespace {

Options tracing_of(const VerifyOptions& options) {
    const auto in = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw Error(std::string("reference: verify: ") + name + " is " + std::to_string(value) +
                        ", " + std::to_string(low) + " to " + std::to_string(high) + " needed");
    };
    in("seconds", options.seconds, 0, 1e9);
    in("decide", options.decide, 0, 1e9);
    in("pixels", options.pixels, 16, 1 << 20);
    in("samples", options.samples, 8, 1 << 20);
    Options out;
    out.effects = options.effects;
    out.threads = options.threads;
    check_options(out);
    return out;
}

Brightness brightness_of(const std::vector<glm::vec3>& radiance, std::size_t width,
                         std::size_t height) {
    if (radiance.size() != width * height || radiance.empty())
        throw Error("reference: verify: the picture has " + std::to_string(radiance.size()) +
                    " pixels, " + std::to_string(width * height) + " needed, at least 1");
    Brightness out{{}, width, height};
    std::size_t bad = 0;
    for (const glm::vec3& rgb : radiance) {
        out.values.push_back(static_cast<float>(luminance(glm::dvec3(rgb))));
        bad += !std::isfinite(out.values.back());
    }
    if (bad > 0)
        throw Error("reference: verify: " + std::to_string(bad) +
                    " pixels of the picture are not finite");
    return out;
}

}  // namespace

Verification PathTracer::verify(const Camera& camera, int width, int height,
                                const std::vector<glm::vec3>& radiance,
                                const VerifyOptions& options, const Progress& progress) const {
    const Options tracing = tracing_of(options);
    if (width < 1 || width > 16384 || height < 1 || height > 16384)
        throw Error("reference: verify: the picture is " + std::to_string(width) + "x" +
                    std::to_string(height) + ", 1x1 to 16384x16384 needed");
    const Brightness brightness =
        brightness_of(radiance, static_cast<std::size_t>(width), static_cast<std::size_t>(height));
    Paths paths = world_->paths(tracing);
    const PixelLight light(world_->geometry, world_->tracer, paths, camera, width, height,
                           options.filter);
    return Verifier(brightness, options, progress, paths,
                    [&](std::size_t pixel, Random& random, std::vector<Met>* met) {
                        return light(pixel, random, met);
                    })
        .run();
}

Verification PathTracer::verify(const std::vector<Place>& places,
                                const std::vector<glm::vec3>& irradiance,
                                const VerifyOptions& options, const Progress& progress) const {
    const Options tracing = tracing_of(options);
    const Brightness brightness = brightness_of(irradiance, places.size(), 1);
    Paths paths = world_->paths(tracing);
    return Verifier(brightness, options, progress, paths,
                    [&](std::size_t place, Random& random, std::vector<Met>* met) {
                        return light_at(places[place], world_->geometry, paths, random, met);
                    })
        .run();
}

}  // namespace clgi::reference
