// What DynamicTransferSolver consists of.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/environment_light.hpp>
#include <clgi/dynamic_transfer.hpp>
#include <clgi/passes/receivers.hpp>

namespace clgi {

// The receivers of a scene: its vertices, and the other sides of some.
struct SceneReceivers {
    SceneReceivers(const Scene& scene, const DeviceScene& device);

    std::uint32_t count() const { return static_cast<std::uint32_t>(exponents.size()); }
    // Other sides look at what their vertices look at.
    void add_other_sides(BlockerLevels& levels) const;

    std::vector<std::uint32_t> other_side;  // [vertices] receiver or RECEIVER_NONE
    std::vector<std::uint32_t> fronts;      // [other sides] vertex
    std::vector<float> exponents;           // [receivers] of the lobes

    // [3][stride] of the receivers' diffuse reflectance: means of the triangles around them.
    std::vector<float> reflectances(const Scene& scene, const DeviceScene& device,
                                    std::size_t stride) const;
};

inline constexpr const char* transfer_owner = "dynamic-transfer";

// All that the solver allocates, and what its size follows from. Without kernels and queue.
struct TransferBuffers {
    // Throws Error for options out of range.
    TransferBuffers(const Scene& file, const DeviceScene& of, const DynamicTransferOptions& wanted);

    BufferTable table();
    void add_shadows(BufferTable& table);

    // Sums over the cells of masks are needed.
    bool integrates() const { return occludes(options.occlusion) || glossy; }

    const DeviceScene& scene;
    DynamicTransferOptions options;
    bool glossy;
    SceneReceivers vertices;
    BlockerLevels levels;
    EnvironmentLight sky;
    ReceiverBuffers receivers;
    BlockerBuffers both;               // levels, with the lists of the hierarchy
    BlockerBuffers fine;               // the scene's triangles alone, one list
    std::size_t listed_triangles = 0;  // of all receivers together
    cl::Buffer triangles, irradiance, gloss, lobes, exponents, other_side, fronts, drawn, heights,
        weights, directions, status, bad, reflectance, exitance;
};

struct DynamicTransferSolver::State : TransferBuffers {
    State(const Programs& programs, const cl::CommandQueue& on, const Scene& file,
          const DeviceScene& of, const DynamicTransferOptions& wanted);

    void build() const;
    void write(const Scene& file);
    void write_shadows(const Scene& file);

    template <typename T>
    void put(const cl::Buffer& buffer, const std::vector<T>& values) {
        if (!values.empty()) record.write(buffer, values.data(), values.size() * sizeof(T));
    }

    void place_receivers();
    void transfer();
    void shade(const cl::Buffer& vectors, const cl::Buffer& out);
    void light();
    void light_openly();
    void bounce();
    void reflect(const glm::vec4& eye);

    // Buffers beside those of the start: of the budget, what these leave.
    void allocate_more(const BufferTable& more);
    cl::Event look(const WaitList& wait);
    VisibleSets sets();
    void restrict(const VisibleSets& sets);

    cl::CommandQueue queue;
    MaskPasses masks;
    ReceiverPasses sides;
    TransferPasses projection;
    mutable Recorder record;
    MaskWeights cells;
    BlockerBuffers blockers;  // with the lists that masks look at: those of both, or visible sets
    cl::Buffer seen;
    std::size_t bytes = 0;
    std::size_t bytes_of_sets = 0;  // of these
};

}  // namespace clgi
