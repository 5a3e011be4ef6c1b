// Self-shadowed light of an environment, without precomputation: for every vertex a mask of the
// directions in which triangles block the view, integrated to a transfer vector, times the light.
//                                                                                      [Kautz04]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/blocker_levels.hpp>
#include <clgi/advanced/interval.hpp>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/advanced/mask_weights.hpp>
#include <clgi/advanced/occlusion.hpp>
#include <clgi/advanced/solver_status.hpp>
#include <clgi/advanced/visible_sets.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/masks.hpp>
#include <clgi/passes/transfer.hpp>
#include <clgi/programs.hpp>
#include <clgi/scene.hpp>
#include <memory>
#include <vector>

namespace clgi {

struct DynamicTransferOptions {
    MaskOptions masks;
    CellIntegral cells = CellIntegral::exact;
    sh::Window window = sh::Window::none;  // of transfer vectors, against ringing
    bool gloss = true;                     // the Phong lobes of materials, where the scene has some
    bool directional = false;              // directional lights are part of the environment
    // none: nothing blocks the environment. There are no blockers, masks and diffuse transfer
    // vectors then: irradiance follows from the normal alone, at vertices and at each pixel. Lobes
    // keep vectors of their own, and of masks only bands, block and size count, for the cells that
    // lobes are integrated over. interreflections must be 0; coarse and rings are not used.
    Occlusion occlusion = Occlusion::automatic;
    // 1: diffuse light that the scene reflects to itself once is part of the irradiance.
    int interreflections = 0;
    // Far from a vertex these triangles block, near it those of the scene
    // (clgi/advanced/blocker_levels.hpp): vertices of the scene, such as mesh::simplify makes.
    // None: all of the scene block everywhere.
    std::vector<glm::uvec3> coarse;
    int rings = 1;  // near a vertex: triangles with a corner at most so many edges away, 0 to 2
    // Bytes that the buffers may take together; 0: what the device has beside the scene.
    std::size_t memory_budget = 0;
    BuildOptions build;
};

// What masks, vectors and light found out, since the start.
// non_finite: packets of receivers whose light is not finite, and receivers for which the bounce
// makes it so.
struct TransferStatus : SolverStatus {
    std::uint32_t bad_receivers = 0;  // whose position or normal is not finite
    std::uint32_t bad_blockers = 0;   // triangles that are not finite; they block nothing
    std::uint32_t bad_texels = 0;     // floats of the environment that are not finite, read as 0
};

// What a DynamicTransferSolver of these will allocate, without look() and restrict(), and what
// transfer(), light() and reflect() may take together. scene: what `device_scene` was made from.
// Throws Error for options out of range; no memory is too small for it.
CLGI_API Estimate estimate(const cl::Device& device, const Scene& scene,
                           const DeviceScene& device_scene,
                           const DynamicTransferOptions& options = {});

// Owns its buffers, works on the given queue (in order or not), never finishes it. The scene must
// outlive the solver. One thread at a time.
//
// Receivers 0 to vertex_count - 1 are the vertices of the device, in its order. Behind them are the
// other sides of those on double-sided surfaces. Masked and blended surfaces block as a whole.
class CLGI_API DynamicTransferSolver {
public:
    // Builds kernels and allocates. scene: what `device` was made from; it is not needed
    // afterwards. Throws Error for options out of range, DeviceError when memory does not suffice.
    DynamicTransferSolver(const Programs& programs, const cl::CommandQueue& queue,
                          const Scene& scene, const DeviceScene& device,
                          const DynamicTransferOptions& options = {});
    ~DynamicTransferSolver();
    DynamicTransferSolver(const DynamicTransferSolver&) = delete;
    DynamicTransferSolver& operator=(const DynamicTransferSolver&) = delete;

    // Reads directional lights again, after DeviceScene::set_light, for the next light().
    void lights_changed();

    // Turns the environment about +Y, radians, beside its own rotation, for the next light().
    void turn_environment(double angle);

    // The turn of the last light().
    double environment_turn() const;

    // Potentially visible sets of an animation known before [Kautz04, section 3.2]. look() enqueues
    // the search for the triangles that receivers see of the geometry as it is now; sets() waits
    // and has those of all looks since it was called last. After restrict(), masks look at such
    // sets alone; they are bit for bit those of before in the frames that were looked at, with
    // exact planes. look() itself always sees everything. Both take memory, of the budget as well.
    // All three throw Error without DynamicTransferOptions::occlusion.
    cl::Event look(const WaitList& wait = {});
    VisibleSets sets();
    void restrict(const VisibleSets& sets);

    // Enqueues masks and transfer vectors of the geometry as it is now (without shadows: receivers
    // alone). Vectors stay good as long as no vertex moves.
    cl::Event transfer(const WaitList& wait = {});

    // Enqueues the projection of the environment and what arrives: irradiance().
    cl::Event light(const WaitList& wait = {});

    // Enqueues what the lobes of materials reflect to an eye, local frame: gloss(). For a scene
    // without lobes, and without DynamicTransferOptions::gloss, no kernel is enqueued.
    cl::Event reflect(const glm::vec3& eye, const WaitList& wait = {});
    // The same; w 1: xyz is the direction to the eye, everywhere: orthographic cameras.
    cl::Event reflect(const glm::vec4& eye, const WaitList& wait = {});

    // What was enqueued last.
    cl::Event last() const;

    // transfer() and light(); false if progress cancelled. Waits after each part.
    bool run(const Progress& progress = nullptr);

    // Waits for what was enqueued.
    TransferStatus status() const;

    // Passes since the last transfer(), light() or reflect() that was not enqueued behind another.
    const std::vector<PassEvent>& events() const;
    Interval interval() const;

    const DynamicTransferOptions& options() const;
    bool glossy() const;  // there are lobes, and they are wanted
    std::size_t bytes() const;

    // Results, valid when the event is complete.
    const ReceiverBuffers& receivers() const;  // with masks and transfer vectors, if shadowed
    const cl::Buffer& irradiance() const;      // [3][receivers().stride] exposed lux
    const cl::Buffer& gloss() const;           // [3][receivers().stride] exposed cd/m^2
    const cl::Buffer& other_side() const;      // [vertex_count] uint: receiver or RECEIVER_NONE
    const cl::Buffer& environment() const;     // [terms] float4: exposed cd/m^2 sr

    // What masks of other receivers of this scene are made with; empty where it needs none.
    CLGI_EXPERIMENTAL const MaskPasses& passes() const;
    CLGI_EXPERIMENTAL const BlockerBuffers& blockers()
        const;  // the scene's own triangles, one list
    CLGI_EXPERIMENTAL double triangles_per_receiver()
        const;                                          // that masks look at, before any is culled
    CLGI_EXPERIMENTAL const cl::Buffer& drawn() const;  // what MaskPasses::mask draws with
    CLGI_EXPERIMENTAL const cl::Buffer& heights() const;   // of pixels, with a bounce
    CLGI_EXPERIMENTAL const cl::Buffer& exitance() const;  // of triangles that block, with a bounce
    CLGI_EXPERIMENTAL const cl::Buffer& weights() const;   // of MaskWeights
    CLGI_EXPERIMENTAL const cl::Buffer& directions() const;  // of MaskWeights
    CLGI_EXPERIMENTAL const cl::Buffer& counter() const;  // [1] uint, of TransferStatus::non_finite

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
