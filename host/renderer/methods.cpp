// SPDX-License-Identifier: MIT
#include "renderer/methods.hpp"

#include <chrono>
#include <clgi/advanced/bake_layout.hpp>
#include <clgi/advanced/moving_elements.hpp>
#include <clgi/advanced/static_bake.hpp>
#include <clgi/device.hpp>
#include <utility>

#include "core/opencl/variants.hpp"

namespace clgi::renderer {
namespace {

void append(std::vector<PassEvent>& to, const std::vector<PassEvent>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

// ---- options ------------------------------------------------------------------------------------

SecondOrderOptions second_order_options(const RendererOptions& options) {
    SecondOrderOptions out = options.second_order;
    const PictureOptions& picture = options.picture;
    out.width = picture.width;
    out.height = picture.height;
    out.direct = picture.direct;
    out.memory_budget = picture.memory_budget;
    out.build = picture.build;
    out.indirect = out.indirect && options.method == Method::second_order;
    out.emitters = picture.emitters;
    out.emitters.vpls = options.second_order.emitters.vpls;
    // VPLs are placed through the views of lights.
    out.emitters.shadows = picture.emitters.shadows || out.indirect;
    return out;
}

LightAtlasOptions light_atlas_options(const RendererOptions& options) {
    LightAtlasOptions out = options.light_atlas;
    out.build = full(options.picture.build);  // the view alone may be half
    return out;
}

AntiradianceOptions antiradiance_options(const RendererOptions& options) {
    AntiradianceOptions out = options.antiradiance;
    out.emitters = options.picture.emitters;
    out.build = options.picture.build;
    return out;
}

DynamicTransferOptions transfer_options(const RendererOptions& options) {
    DynamicTransferOptions out = options.transfer;
    out.build = options.picture.build;
    return out;
}

IrradianceCacheOptions cache_options(const RendererOptions& options) {
    IrradianceCacheOptions out = options.cache;
    out.picture = options.picture;
    out.picture.build = full(options.picture.build);
    return out;
}

// ---- second-order illumination ------------------------------------------------------------------

SecondOrder::SecondOrder(const Setup& s)
    : solver(s.programs, s.queue, s.device, second_order_options(s.options)) {}

bool SecondOrder::prepare(const Progress& progress, std::vector<PassEvent>&) {
    return !progress || progress(1.0);
}

void SecondOrder::geometry_changed(const WaitList& wait) { moves_ = joined(moves_, wait); }

void SecondOrder::reconfigure(const ViewSetup& s) {
    solver.reconfigure(second_order_options(s.options));
}

cl::Event SecondOrder::render(const Camera& camera, const WaitList& wait) {
    return solver.render(camera, joined(std::exchange(moves_, {}), wait));
}

void SecondOrder::add_passes(std::vector<PassEvent>& passes) const {
    append(passes, solver.events());
}

RendererStatus SecondOrder::status() const { return {solver.status(), {}}; }

// ---- light atlas --------------------------------------------------------------------------------

LightAtlas::LightAtlas(const Setup& s) : whole_(s.device), least_change_(s.options.least_change) {
    const RendererOptions& o = s.options;
    check_bake_fits(s.programs.device(), o.vpls);
    const auto begin = std::chrono::steady_clock::now();
    BakeLayout layout;
    std::vector<BakePoint> points;
    if (o.animated && moves(s.scene)) {
        StaticBake bake = make_static_bake(s.scene, o.vpls, o.layout);
        static_part_ = std::make_unique<DeviceScene>(s.programs.context(), s.programs.device(),
                                                     bake.static_scene.scene);
        if (bake.static_scene.moving_emission)
            warnings_.emplace_back("what moves emits, but lights nothing indirectly");
        layout = std::move(bake.layout);
        shown_ = std::move(bake.whole);
        volume_ = bake.volume;
        points = points_of(bake.volume);
    } else {
        layout = make_bake_layout(s.scene, o.vpls, o.layout);
        shown_ = layout.atlas;
    }
    warnings_.insert(warnings_.begin(), shown_.warnings.begin(), shown_.warnings.end());
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - begin;
    summary = {layout.vpls.vpls.size(), shown_.texels.size(), shown_.pages, shown_.size,
               taken.count()};
    solver = std::make_unique<LightAtlasSolver>(
        s.programs, s.queue, static_part_ ? *static_part_ : s.device, layout.vpls, layout.atlas,
        light_atlas_options(o), points);
    reconfigure(s);
}

bool LightAtlas::prepare(const Progress& progress, std::vector<PassEvent>& passes) {
    const bool done = updates_ && least_change_ > 0.0 ? solver->update(least_change_, progress)
                                                      : solver->run(progress);
    updates_ = false;
    append(passes, solver->events());
    return done;
}

void LightAtlas::lights_changed() {
    if (static_part_) static_part_->set_lights(whole_.lights());
    solver->lights_changed();
    view_->lights_changed();
    updates_ = true;
}

void LightAtlas::geometry_changed(const WaitList& wait) {
    if (!static_part_)
        throw Error(
            "renderer: geometry_changed(): the atlas is baked for geometry that stands "
            "still; RendererOptions::animated needed, and an animation that moves it");
    moves_ = joined(moves_, wait);
}

void LightAtlas::reconfigure(const ViewSetup& s) {
    view_ = std::make_unique<LightAtlasView>(s.programs, s.queue, s.device, shown_,
                                             s.options.picture, volume_);
}

cl::Event LightAtlas::render(const Camera& camera, const WaitList& wait) {
    return view_->render(camera, solver->irradiance_planes(), solver->stride(),
                         joined(std::exchange(moves_, {}), wait));
}

void LightAtlas::add_passes(std::vector<PassEvent>& passes) const {
    append(passes, view_->picture().events());
}

RendererStatus LightAtlas::status() const {
    RendererStatus out{solver->status(), warnings_};
    out.non_finite += view_->picture().non_finite();
    return out;
}

std::size_t LightAtlas::bytes() const {
    return solver->bytes() + view_->picture().bytes() + (static_part_ ? static_part_->bytes() : 0);
}

// ---- antiradiance -------------------------------------------------------------------------------

namespace {

AntiradianceOptions with_poses(const Setup& s) {
    AntiradianceOptions out = antiradiance_options(s.options);
    if (s.options.animated && out.poses.empty() && s.scene.animation)
        out.poses = vertex_poses(s.scene, s.options.clip, s.options.poses);
    return out;
}

}  // namespace

Antiradiance::Antiradiance(const Setup& s) : Shown(s, with_poses(s)) { reconfigure(s); }

void Antiradiance::reconfigure(const ViewSetup& s) {
    view = std::make_unique<AntiradianceView>(s.programs, s.queue, s.device, solver,
                                              s.options.picture);
}

bool Antiradiance::prepare(const Progress& progress, std::vector<PassEvent>& passes) {
    const bool done = solver.run(progress);
    append(passes, solver.events());
    return done && !solver.status().given_up;
}

void Antiradiance::geometry_changed(const WaitList& wait) {
    if (solver.moving_elements() > 0) solver.geometry_changed(wait);
    moves_ = joined(moves_, wait);
}

void Antiradiance::environment_changed() {
    solver.environment_changed();
    lights_changed();
}

void Antiradiance::add_passes(std::vector<PassEvent>& passes) const {
    append(passes, view->picture().events());
}

// ---- dynamic transfer ---------------------------------------------------------------------------

namespace {

DynamicTransferViewOptions view_options(const RendererOptions& options) {
    DynamicTransferViewOptions out = options.transfer_view;
    out.picture = options.picture;
    return out;
}

}  // namespace

Transfer::Transfer(const Setup& s) : Shown(s, transfer_options(s.options)) { reconfigure(s); }

void Transfer::reconfigure(const ViewSetup& s) {
    view = std::make_unique<DynamicTransferView>(s.programs, s.queue, s.device, solver,
                                                 view_options(s.options));
}

bool Transfer::prepare(const Progress& progress, std::vector<PassEvent>& passes) {
    if (progress && !progress(0.0)) return false;
    if (moved_) {
        solver.transfer(moves_);
        append(passes, solver.events());
        if (progress) {
            solver.last().wait();
            if (!progress(0.9)) return false;
        }
    }
    solver.light();
    append(passes, solver.events());
    moved_ = false;
    if (!progress) return true;
    solver.last().wait();
    return progress(1.0);
}

void Transfer::geometry_changed(const WaitList& wait) {
    moved_ = true;
    moves_ = joined(moves_, wait);
}

void Transfer::add_passes(std::vector<PassEvent>& passes) const {
    if (solver.glossy()) append(passes, solver.events());
    append(passes, view->picture().events());
}

// ---- irradiance cache ---------------------------------------------------------------------------

bool Cache::prepare(const Progress& progress, std::vector<PassEvent>&) {
    return !progress || progress(1.0);
}

void Cache::reconfigure(const ViewSetup& s) {
    solver =
        std::make_unique<IrradianceCache>(s.programs, s.queue, s.device, cache_options(s.options));
}

void Cache::sample(std::uint32_t index) {
    again_ = index > 0;
    solver->sample(index);
}

cl::Event Cache::render(const Camera& camera, const WaitList& wait) {
    const WaitList all = joined(std::exchange(moves_, {}), wait);
    return again_ ? solver->render_again(camera, all) : solver->render(camera, all);
}

void Cache::add_passes(std::vector<PassEvent>& passes) const { append(passes, solver->events()); }

}  // namespace clgi::renderer
