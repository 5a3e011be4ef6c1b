// Each method as the renderer sees it: its solver, what shows its light, and what follows a change.
// All have the same members, so that the renderer has one line for each.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/renderer.hpp>
#include <utility>

namespace clgi::renderer {

// What views are made from, beside the solver.
struct ViewSetup {
    const Programs& programs;
    const cl::CommandQueue& queue;
    const DeviceScene& device;
    const RendererOptions& options;
};

// What methods are made from.
struct Setup : ViewSetup {
    const Scene& scene;
};

struct Radiance {
    const cl::Buffer& planes;
    std::uint32_t stride;
};

// Second-order illumination, and direct light alone.
class SecondOrder {
public:
    explicit SecondOrder(const Setup& setup);
    bool prepare(const Progress& progress, std::vector<PassEvent>& passes);
    void lights_changed() { solver.lights_changed(); }
    void geometry_changed(const WaitList& wait);
    void environment_changed() { lights_changed(); }
    void reconfigure(const ViewSetup& setup);
    void sample(std::uint32_t index) { solver.set_sample(index); }
    cl::Event render(const Camera& camera, const WaitList& wait);
    void add_passes(std::vector<PassEvent>& passes) const;
    Radiance radiance() const { return {solver.radiance(), solver.stride()}; }
    const EmitterSet& emitters() const { return solver.emitters(); }
    RendererStatus status() const;
    std::size_t bytes() const { return solver.bytes(); }

    SecondOrderSolver solver;

private:
    WaitList moves_;
};

// A light atlas: of the scene, or of what never moves with a volume for what does.
class LightAtlas {
public:
    explicit LightAtlas(const Setup& setup);
    bool prepare(const Progress& progress, std::vector<PassEvent>& passes);
    void lights_changed();
    void geometry_changed(const WaitList& wait);
    void environment_changed() { lights_changed(); }
    void reconfigure(const ViewSetup& setup);
    void sample(std::uint32_t index) { view_->sample(index); }
    cl::Event render(const Camera& camera, const WaitList& wait);
    void add_passes(std::vector<PassEvent>& passes) const;
    Radiance radiance() const { return {view_->picture().radiance(), view_->picture().stride()}; }
    const EmitterSet& emitters() const { return view_->picture().emitters(); }
    RendererStatus status() const;
    std::size_t bytes() const;

    BakeSummary summary;
    std::unique_ptr<LightAtlasSolver> solver;

private:
    const DeviceScene& whole_;
    std::unique_ptr<DeviceScene> static_part_;  // none: the scene itself is baked
    AtlasLayout shown_;
    std::optional<IrradianceVolume> volume_;
    std::unique_ptr<LightAtlasView> view_;
    std::vector<std::string> warnings_;
    double least_change_;
    bool updates_ = false;  // only lights have changed since the last bake
    WaitList moves_;
};

// What a picture begins after besides what its caller says: moves of vertices.
inline WaitList joined(WaitList moves, const WaitList& wait) {
    moves.insert(moves.end(), wait.begin(), wait.end());
    return moves;
}

// A solver, and the view that shows its light.
template <typename Solver, typename View>
class Shown {
public:
    template <typename Options>
    Shown(const Setup& s, const Options& options)
        : solver(s.programs, s.queue, s.scene, s.device, options) {}

    void lights_changed() {
        solver.lights_changed();
        view->lights_changed();
    }
    void sample(std::uint32_t index) { view->sample(index); }
    cl::Event render(const Camera& camera, const WaitList& wait) {
        return view->render(camera, joined(std::exchange(moves_, {}), wait));
    }
    Radiance radiance() const { return {view->picture().radiance(), view->picture().stride()}; }
    const EmitterSet& emitters() const { return view->picture().emitters(); }
    RendererStatus status() const {
        RendererStatus out{solver.status(), {}};
        out.non_finite += view->picture().non_finite();
        return out;
    }
    std::size_t bytes() const { return solver.bytes() + view->bytes(); }

    Solver solver;
    std::unique_ptr<View> view;

protected:
    WaitList moves_;
};

class Antiradiance : public Shown<AntiradianceSolver, AntiradianceView> {
public:
    explicit Antiradiance(const Setup& setup);
    bool prepare(const Progress& progress, std::vector<PassEvent>& passes);
    void geometry_changed(const WaitList& wait);
    void environment_changed();
    void reconfigure(const ViewSetup& setup);
    void add_passes(std::vector<PassEvent>& passes) const;
};

class Transfer : public Shown<DynamicTransferSolver, DynamicTransferView> {
public:
    explicit Transfer(const Setup& setup);
    bool prepare(const Progress& progress, std::vector<PassEvent>& passes);
    void geometry_changed(const WaitList& wait);
    void environment_changed() { lights_changed(); }
    void reconfigure(const ViewSetup& setup);
    void add_passes(std::vector<PassEvent>& passes) const;

private:
    bool moved_ = true;  // vectors are of another pose
};

// An irradiance cache, which is made anew for each picture.
class Cache {
public:
    explicit Cache(const Setup& setup) { reconfigure(setup); }
    bool prepare(const Progress& progress, std::vector<PassEvent>& passes);
    void lights_changed() { solver->lights_changed(); }
    void geometry_changed(const WaitList& wait) { moves_ = joined(moves_, wait); }
    void environment_changed() { lights_changed(); }
    void reconfigure(const ViewSetup& setup);
    void sample(std::uint32_t index);
    cl::Event render(const Camera& camera, const WaitList& wait);
    void add_passes(std::vector<PassEvent>& passes) const;
    Radiance radiance() const { return {solver->picture().radiance(), solver->picture().stride()}; }
    const EmitterSet& emitters() const { return solver->picture().emitters(); }
    RendererStatus status() const { return {solver->status(), {}}; }
    std::size_t bytes() const { return solver->bytes(); }

    std::unique_ptr<IrradianceCache> solver;

private:
    WaitList moves_;
    bool again_ = false;  // by the records of the last picture
};

// Options of the method's solver with what is common to all methods.
SecondOrderOptions second_order_options(const RendererOptions& options);
LightAtlasOptions light_atlas_options(const RendererOptions& options);
AntiradianceOptions antiradiance_options(const RendererOptions& options);
DynamicTransferOptions transfer_options(const RendererOptions& options);
IrradianceCacheOptions cache_options(const RendererOptions& options);

}  // namespace clgi::renderer
