// SPDX-License-Identifier: MIT
#include <clgi/advanced/antiradiance_view.hpp>
#include <clgi/advanced/planes.hpp>
#include <optional>

#include "shading/kit/eye.hpp"
#include "shading/kit/without_sky.hpp"

namespace clgi {
struct AntiradianceView::State {
    State(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& of,
          const AntiradianceSolver& from, const PictureOptions& options)
        : scene(of),
          solver(from),
          picture(programs, queue, of, without_sky(options), "antiradiance-view"),
          passes(programs, from.options().bins, picture.options().build) {
        picture.allocate(picture.table(), solver.bytes());
        passes.build({"show"});
        if (solver.gloss().count == 0) return;
        gloss_passes.emplace(programs, from.options().bins, picture.options().build);
        gloss_passes->build({"show_gloss"});
    }

    cl::Event render(const Camera& camera, const WaitList& wait) {
        WaitList ready = wait;
        if (solver.last()()) ready.push_back(solver.last());
        const View view = picture.begin(camera, ready);
        const glm::vec4 eye = eye_of(view);
        const auto pixels = static_cast<std::uint32_t>(picture.pixels());
        const ShowElementsParams params{eye, pixels, picture.stride(), scene.info().triangle_count,
                                        solver.links().element_count};
        Recorder& record = picture.record();
        record("antiradiance.show", pixels, [&](const WaitList& before) {
            return passes.show(record.queue(), params, scene, solver.links(), solver.surface(),
                               picture.gbuffer(), picture.irradiance(), before);
        });
        picture.combine(view);
        if (gloss_passes) add_gloss(eye);
        return picture.end(view);
    }

    // What lobes reflect of all light but direct light, which the picture has.
    void add_gloss(const glm::vec4& eye) {
        const auto pixels = static_cast<std::uint32_t>(picture.pixels());
        const ShowGlossParams params{eye,
                                     pixels,
                                     picture.stride(),
                                     scene.info().triangle_count,
                                     solver.links().element_count,
                                     static_cast<float>(scene.frame().exposure),
                                     0,
                                     0,
                                     0};
        Recorder& record = picture.record();
        record("antiradiance.show_gloss", pixels, [&](const WaitList& before) {
            return gloss_passes->show(record.queue(), params, scene, solver.links(),
                                      solver.surface(), solver.gloss(), picture.gbuffer(),
                                      picture.radiance(), picture.counter(), before);
        });
    }

    const DeviceScene& scene;
    const AntiradianceSolver& solver;
    Picture picture;
    AntiradiancePasses passes;
    std::optional<AntiradianceGlossPasses> gloss_passes;  // none without glossy leaves
};

AntiradianceView::AntiradianceView(const Programs& programs, const cl::CommandQueue& queue,
                                   const DeviceScene& scene, const AntiradianceSolver& solver,
                                   const PictureOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, solver, options)) {}

AntiradianceView::~AntiradianceView() = default;

void AntiradianceView::lights_changed() { state_->picture.lights_changed(); }
void AntiradianceView::sample(std::uint32_t index) { state_->picture.sample(index); }

cl::Event AntiradianceView::render(const Camera& camera, const WaitList& wait) {
    return state_->render(camera, wait);
}

const Picture& AntiradianceView::picture() const { return state_->picture; }

std::size_t AntiradianceView::bytes() const { return state_->picture.bytes(); }

}  // namespace clgi
