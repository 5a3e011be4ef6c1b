// Whole frames and everything they leave behind.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/second_order.hpp>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "device.hpp"

namespace clgi::test {

struct Frame {
    std::size_t pixels = 0;
    SceneFrame place;
    RenderStatus status;
    std::size_t launches = 0;
    std::vector<glm::vec3> radiance;    // [height][width] cd/m^2
    std::vector<glm::vec3> position;    // [height][width] local frame
    std::vector<glm::vec3> irradiance;  // [height][width] local frame, exposed; indirect
    std::vector<Vpl> lights;            // [N]
    std::vector<Vpl> negative;

    glm::dvec3 world(std::size_t pixel) const {
        return glm::dvec3(position[pixel]) / place.scale + place.origin;
    }
};

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

inline std::vector<glm::vec3> vectors(const cl::CommandQueue& queue, const cl::Buffer& planes,
                                      std::size_t stride, std::size_t count) {
    std::vector<float> values(3 * stride);
    queue.enqueueReadBuffer(planes, CL_TRUE, 0, values.size() * sizeof(float), values.data());
    std::vector<glm::vec3> out;
    for (std::size_t i = 0; i < count; ++i)
        out.emplace_back(values[i], values[stride + i], values[2 * stride + i]);
    return out;
}

// Three planes of irradiance as they are stored.
inline std::vector<glm::vec3> irradiance_vectors(const cl::CommandQueue& queue,
                                                 const SecondOrderSolver& solver,
                                                 std::size_t count) {
    const std::size_t stride = solver.stride();
    if (solver.options().build.storage == Storage::full)
        return vectors(queue, solver.irradiance(), stride, count);
    std::vector<std::uint16_t> values(3 * stride);
    queue.enqueueReadBuffer(solver.irradiance(), CL_TRUE, 0, values.size() * sizeof values[0],
                            values.data());
    std::vector<glm::vec3> out;
    for (std::size_t i = 0; i < count; ++i)
        out.emplace_back(glm::unpackHalf1x16(values[i]), glm::unpackHalf1x16(values[stride + i]),
                         glm::unpackHalf1x16(values[2 * stride + i]));
    return out;
}

inline Frame read_frame(const cl::CommandQueue& queue, const DeviceScene& scene,
                        const SecondOrderSolver& solver) {
    const SecondOrderOptions& options = solver.options();
    Frame out;
    out.pixels = static_cast<std::size_t>(options.width) * options.height;
    out.place = scene.frame();
    out.launches = solver.events().size();
    out.status = solver.status();
    out.radiance = vectors(queue, solver.radiance(), solver.stride(), out.pixels);
    if (out.launches == 0) return out;
    out.position = vectors(queue, solver.planes(), solver.stride(), out.pixels);
    if (!options.indirect || solver.emitters().vpl_count == 0) return out;
    out.irradiance = irradiance_vectors(queue, solver, out.pixels);
    const auto read = [&](const cl::Buffer& buffer, std::size_t count) {
        std::vector<Vpl> lights(count);
        if (count > 0)
            queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(Vpl), lights.data());
        return lights;
    };
    out.lights = read(solver.vpls(), solver.emitters().vpl_count);
    out.negative = read(solver.negative_vpls(), static_cast<std::size_t>(options.negative_vpls));
    return out;
}

inline Frame render(const Scene& scene, const Camera& camera, const SecondOrderOptions& options,
                    const cl::CommandQueue& queue = device().queue) {
    const DeviceScene placed = on_device(scene);
    SecondOrderSolver solver(programs(), queue, placed, options);
    solver.render(camera).wait();
    return read_frame(queue, placed, solver);
}

}  // namespace clgi::test
