// Global illumination without visibility: light goes through everything, and antiradiance takes
// away behind each surface what arrived before it.                          [Dachsbacher07]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/elements.hpp>
#include <clgi/advanced/emitters.hpp>
#include <clgi/advanced/interval.hpp>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/advanced/links.hpp>
#include <clgi/advanced/moving_elements.hpp>
#include <clgi/advanced/occlusion.hpp>
#include <clgi/advanced/solver_status.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/antiradiance_gloss.hpp>
#include <clgi/programs.hpp>
#include <clgi/scene.hpp>
#include <memory>
#include <vector>

namespace clgi {

// The order of reflections and of steps in which light is let through [section 2.2]. Where nothing
// can lie between two elements they are the same, and steps are those of `symmetric`.
enum class Iteration {
    symmetric,   // both at once; diverges where parallel surfaces lie close to each other
    asymmetric,  // light is let through until it no longer changes, then reflected; converges
                 // wherever bins are right about what hides what
    automatic,   // symmetric, and asymmetric from the start where that diverges
};

struct AntiradianceOptions {
    int bins = 128;  // of directions, a multiple of 4, 32 to 4096
    ElementOptions elements;
    LinkOptions links;
    // What the scene's vertices do, if they move: links are made for all of these poses, and
    // geometry_changed() brings them to where the vertices are. See
    // clgi/advanced/moving_elements.hpp. The solver keeps no copy: options() has none.
    VertexPoses poses;
    // Shadow maps and samples of the lights; vpls and environment_lights are not used: the
    // environment arrives in bins.
    EmitterOptions emitters;
    // Where no element has antiradiance there is nothing to let through: it is symmetric.
    Iteration iteration = Iteration::automatic;
    // Elements that something may lie behind have antiradiance, or always all; none is refused:
    // implicit visibility is the method.
    Occlusion occlusion = Occlusion::automatic;
    // Leaves whose material's lobe reflects more than this share of all light, 0 to 1, send gloss
    // along every bin; others are diffuse alone. 1: all are.
    double least_gloss = 1e-4;
    // Local passes, 1 to 10000; 0: until the residual is small. Where the symmetric iteration is
    // given up the asymmetric one makes as many again.
    int steps = 0;
    // Of the asymmetric iteration: steps that let light through for each one that reflects, up to
    // 1000; 0: until what they change is a tenth of it.
    int through_steps = 0;
    // Change of what arrives in a step, of what arrived in the first: 1e-6 to 1.
    double residual = 1e-3;
    int most_steps = 500;  // with steps = 0
    // Bytes that the solver's buffers may take together; 0: what the device has beside the scene.
    std::size_t memory_budget = 0;
    BuildOptions build;
};

// converged: the residual is below the bound. given_up: the iteration that was used last diverged,
// and leaves receive nothing. non_finite: leaves, in all steps of the iteration that was used.
struct AntiradianceStatus : SolverStatus {
    Iteration iteration = Iteration::symmetric;  // that was used last
    bool diverged = false;                       // the symmetric iteration did, and was given up
    bool lets_through = false;      // false: nothing can lie between; there is no antiradiance
    std::vector<double> residuals;  // of each step that was made, of both iterations
};

// What an AntiradianceSolver of these options will allocate, and how long its run() will take,
// about. Elements are made, and the links of 128 leaves are counted in place of all: that takes a
// fifth of the time of linking at most. Bytes are within a twentieth as a rule. Milliseconds are of
// `steps` steps. Where these are 0, they are of 20, about what the symmetric iteration takes; where
// that is given up run() takes ten times as long. scene: what `device_scene` was made from. Throws
// for options and scenes that the solver refuses, but not for what only all links show: too little
// memory, more than 2^32 links, or a form factor that is not finite.
CLGI_API Estimate estimate(const cl::Device& device, const Scene& scene,
                           const DeviceScene& device_scene,
                           const AntiradianceOptions& options = {});

// Owns its buffers, works on the given queue (in order or not). The scene must outlive the solver
// and stay as it was uploaded, but for what options.poses move. One thread at a time.
//
// Geometry that moves keeps its elements and links; where the elements are, and bins and form
// factors of links of which an end moves, are computed anew on the device. Everything else costs
// what it costs for a still scene. Between and beside the poses that were given light is as right
// as links allow that were made for those: links that are missing are those between elements that
// never faced each other, and near each other large elements exchange light. Leaves keep their
// number: where a triangle grows so do they. Triangles that have no normal in the scene's own
// arrays are no elements in any pose.
//
// Surfaces with lobes exchange gloss as well, in bins. What emissive surfaces send comes through
// their sample points, as direct light. Masked and blended surfaces block as a whole.
class CLGI_API AntiradianceSolver {
public:
    // Makes elements and links, builds kernels and allocates. scene: what `device` was made from;
    // it is not needed afterwards. Throws Error for options out of range and scenes without
    // surfaces, DeviceError when memory does not suffice.
    AntiradianceSolver(const Programs& programs, const cl::CommandQueue& queue, const Scene& scene,
                       const DeviceScene& device, const AntiradianceOptions& options = {});
    ~AntiradianceSolver();
    AntiradianceSolver(const AntiradianceSolver&) = delete;
    AntiradianceSolver& operator=(const AntiradianceSolver&) = delete;

    // Reads the scene's lights again, after DeviceScene::set_light, for the next run().
    void lights_changed();

    // Reads the scene's environment again, after DeviceScene::turn_environment, for the next run().
    void environment_changed();

    // The scene's vertices moved (SceneAnimator, SceneMover): the next run() has elements and links
    // where they are. It begins after `wait`, the event of the move. Throws Error for a solver that
    // was made without poses, or with those of vertices that all stand still, and if the move gave
    // the scene another local frame.
    void geometry_changed(const WaitList& wait = {});

    // Direct light into the leaves, then steps until they are done or the residual is small; waits
    // for each, and for all of it. Pictures of the light before must have ended. False if progress
    // cancelled.
    bool run(const Progress& progress = nullptr);

    AntiradianceStatus status() const;

    // What was enqueued last: pictures of the light wait for it.
    cl::Event last() const;

    // Passes of the last run, and what it took on the queue.
    const std::vector<PassEvent>& events() const;
    Interval interval() const;

    const AntiradianceOptions& options() const;
    const ElementTree& elements() const;
    const DirectionBins& bins() const;
    std::size_t link_count() const;                    // for one direction each
    CLGI_EXPERIMENTAL std::size_t link_pairs() const;  // Links::pairs
    std::size_t moving_links() const;                  // those of which an end moves
    std::size_t moving_elements() const;
    // Rows of exitant intensity: one for each element of which some link reads what it sends in
    // directions of their own, and for all elements below those. They are elements with something
    // behind, glossy leaves, clusters that are not flat, and what moves.
    CLGI_EXPERIMENTAL std::size_t row_count() const;
    double linking_seconds() const;  // that elements and links took
    std::size_t bytes() const;
    CLGI_EXPERIMENTAL std::size_t table_bytes() const;  // of them, intensities and incident light
    CLGI_EXPERIMENTAL std::size_t link_bytes() const;   // and links

    // Results, valid after run().
    const LeafBuffers& leaves() const;
    const std::vector<std::uint32_t>& leaf_elements() const;  // [rows] of LeafBuffers
    const LinkBuffers& links() const;
    const LeafSurface& surface() const;
    const GlossBuffers& gloss() const;  // count is 0 where no leaf is glossy
    CLGI_EXPERIMENTAL const AntiradiancePasses& passes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
