// Geometry that moves: new positions and normals for vertices of a scene on the device.
//
// A solver given moved geometry gives the bits of a scene that was loaded that way, as long as the
// local frame is the same: geometry that moves inside the box of what stands still, or `refit`.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/scene.hpp>
#include <cstdint>
#include <optional>
#include <vector>

namespace clgi {

// Vertices first .. first + count - 1 of the scene as it was loaded (DeviceScene::vertex_order
// leads there), in buffers of the caller's: made by another kernel, or shared with another API.
struct MovedVertices {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    cl::Buffer positions;                 // [count] float4: xyz, metres from origin; w is not read
    cl::Buffer normals;                   // [count] float4: xyz, unit; none: normals stay
    glm::dvec3 origin = glm::dvec3(0.0);  // world point, metres
    std::optional<Bounds> refit;          // see SceneMover::move
};

// What moves found since the last call of SceneMover::status().
struct MoveStatus {
    std::uint32_t not_finite = 0;  // vertices that stayed as they were: a number was not finite
    double farthest = 0.0;         // metres from the frame's origin to the farthest moved vertex
    bool fits = true;              // all moved vertices are within the frame's box
};

// Writes a scene's buffers from the given queue, in order or not. Kernels are built once. Scene and
// mover are used by one thread at a time; the scene must outlive the mover.
class CLGI_API SceneMover {
public:
    SceneMover(const cl::CommandQueue& queue, DeviceScene& scene, const BuildOptions& options = {});

    // With kernels that others share.
    SceneMover(const Programs& programs, const cl::CommandQueue& queue, DeviceScene& scene,
               const BuildOptions& options = {});

    SceneMover(const SceneMover&) = delete;
    SceneMover& operator=(const SceneMover&) = delete;

    // Enqueues the move after `wait` and after earlier moves; the returned event completes when
    // positions, normals, clusters, their parts and boxes are written. Whatever reads the scene
    // must wait for it, and `wait` must cover whatever still reads: the event of the last frame.
    //
    // The local frame stays as it is: its precision, its radius and its box, on which far planes
    // and the views of directional lights depend, suit the scene that was loaded. status().fits
    // tells when it no longer does. With `refit`, the box around all triangles in metres, the frame
    // becomes the one that a fresh load would find; then all vertices must be given.
    //
    // Waits only where vertices of emissive triangles move: their corners are read back, as the
    // host samples them. Then, and after a refit, a solver needs lights_changed(). The exposure
    // stays.
    //
    // Throws Error for vertices that the scene does not have and for buffers too small.
    cl::Event move(const MovedVertices& vertices, const WaitList& wait = {});

    // The same from the host, positions in metres. Waits until the vectors have been copied.
    // normals: as many, or none, and they stay.
    cl::Event move(std::uint32_t first, const std::vector<glm::dvec3>& positions,
                   const std::vector<glm::vec3>& normals, bool refit = false,
                   const WaitList& wait = {});

    // Waits for the last move, reads three words and sets them back.
    MoveStatus status();

private:
    void check(std::uint32_t first, std::size_t count, const std::optional<Bounds>& refit) const;
    cl::Event enqueue(const MoveParams& params, const cl::Buffer& positions,
                      const cl::Buffer& normals, const WaitList& wait);
    void refit(const Bounds& box);
    void read_emissive(std::uint32_t first, std::size_t count);
    const WaitList& pending();

    cl::CommandQueue queue_;
    DeviceScene& scene_;
    ScenePasses passes_;
    cl::Buffer vertex_order_, status_, staged_positions_, staged_normals_;
    WaitList last_;  // the end of the last move; empty before the first
};

}  // namespace clgi
