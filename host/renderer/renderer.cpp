// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/renderer.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <variant>

#include "core/opencl/check.hpp"
#include "renderer/methods.hpp"
#include "renderer/samples.hpp"

namespace clgi {
namespace {

constexpr std::pair<Method, const char*> names[] = {{Method::direct, "direct"},
                                                    {Method::second_order, "second-order"},
                                                    {Method::light_atlas, "atlas"},
                                                    {Method::antiradiance, "antiradiance"},
                                                    {Method::dynamic_transfer, "transfer"},
                                                    {Method::irradiance_cache, "cache"}};

using Made =
    std::variant<std::monostate, std::unique_ptr<renderer::SecondOrder>,
                 std::unique_ptr<renderer::LightAtlas>, std::unique_ptr<renderer::Antiradiance>,
                 std::unique_ptr<renderer::Transfer>, std::unique_ptr<renderer::Cache>>;

Made make(const renderer::Setup& setup) {
    switch (setup.options.method) {
        case Method::light_atlas:
            return std::make_unique<renderer::LightAtlas>(setup);
        case Method::antiradiance:
            return std::make_unique<renderer::Antiradiance>(setup);
        case Method::dynamic_transfer:
            return std::make_unique<renderer::Transfer>(setup);
        case Method::irradiance_cache:
            return std::make_unique<renderer::Cache>(setup);
        default:
            return std::make_unique<renderer::SecondOrder>(setup);
    }
}

void check(const RendererOptions& options) {
    const auto refuse = [](bool wrong, const char* why) {
        if (wrong) throw Error(std::string("renderer: ") + why);
    };
    refuse(!(options.least_change >= 0.0) || !std::isfinite(options.least_change),
           "least_change is negative or not finite");
    need_range("renderer", "samples", options.samples, 1, 1 << 20);
}

}  // namespace

const char* name_of(Method method) {
    for (const auto& [which, name] : names)
        if (which == method) return name;
    return "";
}

std::optional<Method> method_of(const std::string& name) {
    for (const auto& [which, word] : names)
        if (name == word) return which;
    return std::nullopt;
}

struct Renderer::State {
    State(const Programs& all, const cl::CommandQueue& on, const Scene& file, DeviceScene& of,
          const RendererOptions& wanted)
        : programs(all), queue(on), scene(&file), device(&of), options(wanted) {
        check(options);
    }

    State(const Programs& all, const cl::CommandQueue& on, const Scene& file,
          const RendererOptions& wanted)
        : programs(all),
          queue(on),
          own_scene(file),
          own_device(std::in_place, programs.context(), programs.device(), file),
          scene(&*own_scene),
          device(&*own_device),
          options(wanted) {
        check(options);
    }

    // Calls with the method, which is made where it is not yet.
    template <typename Call>
    decltype(auto) with(Call&& call) {
        build();
        return of(std::forward<Call>(call));
    }

    template <typename Call>
    auto of(Call&& call) const -> decltype(call(std::declval<renderer::SecondOrder&>())) {
        return std::visit(
            [&](const auto& method) -> decltype(call(std::declval<renderer::SecondOrder&>())) {
                if constexpr (std::is_same_v<std::decay_t<decltype(method)>, std::monostate>)
                    throw Error("renderer: nothing was rendered yet");
                else
                    return call(*method);
            },
            made);
    }

    void build() {
        if (made.index() > 0) return;
        made = make({{programs, queue, *device, options}, *scene});
        own_scene.reset();
        scene = nullptr;
    }

    bool prepare(const Progress& progress) {
        passes.clear();
        const bool done = with([&](auto& method) { return method.prepare(progress, passes); });
        // A method that gave up has done what it can: it is not tried again before a change.
        prepared = done || of([](auto& method) { return method.status().given_up; });
        return done;
    }

    template <typename Change>
    void changed(const Change& change) {
        if (made.index() == 0) return;  // it is made from what is there then
        of(change);
        samples.forget();
        prepared = false;
    }

    void begin_picture() {
        if (!prepared) prepare(nullptr);
        if (shown) passes.clear();
        shown = true;
    }

    // One sample of the picture; its passes are added.
    cl::Event sample(const Camera& camera, std::uint32_t index, const WaitList& wait) {
        return of([&](auto& method) {
            method.sample(index);
            const cl::Event done = method.render(renderer::sampled(camera, index), wait);
            method.add_passes(passes);
            return done;
        });
    }

    cl::Event refine() {
        if (samples.count() == 0)
            throw Error("renderer: refine(): there is no picture of a camera yet");
        samples.keep(radiance(), pixels(), last);
        last = sample(samples.camera(), samples.count(), {last});
        passes.push_back(samples.add(radiance(), pixels(), last));
        return last = passes.back().event;
    }

    void drew(const Camera& camera, const cl::Event& first) {
        samples.begin(camera);
        last = first;
    }

    void finish_samples() {
        while (samples.count() < static_cast<std::uint32_t>(options.samples)) refine();
    }

    renderer::Radiance radiance() const {
        return of([](auto& method) { return method.radiance(); });
    }
    std::size_t pixels() const {
        return static_cast<std::size_t>(options.picture.width) *
               static_cast<std::size_t>(options.picture.height);
    }

    Programs programs;
    cl::CommandQueue queue;
    renderer::Samples samples{programs, queue};
    cl::Event last;                  // of the picture
    std::optional<Scene> own_scene;  // until the method is made
    std::optional<DeviceScene> own_device;
    const Scene* scene;
    DeviceScene* device;
    RendererOptions options;
    Made made;
    bool prepared = false;
    bool shown = false;             // a picture since what `passes` holds was prepared
    std::vector<PassEvent> passes;  // of what was prepared, then of the picture
};

Renderer::Renderer(const cl::CommandQueue& queue, const Scene& scene,
                   const RendererOptions& options)
    : Renderer(Programs(queue.getInfo<CL_QUEUE_CONTEXT>(), queue.getInfo<CL_QUEUE_DEVICE>()), queue,
               scene, options) {}

Renderer::Renderer(const Programs& programs, const cl::CommandQueue& queue, const Scene& scene,
                   const RendererOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, options)) {}

Renderer::Renderer(const Programs& programs, const cl::CommandQueue& queue, const Scene& scene,
                   DeviceScene& device_scene, const RendererOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, device_scene, options)) {}

Renderer::~Renderer() = default;

Estimate Renderer::estimate() const {
    const State& s = *state_;
    if (!s.scene) throw Error("renderer: estimate() comes before build()");
    const cl::Device& device = s.programs.device();
    switch (s.options.method) {
        case Method::light_atlas:
            return clgi::estimate(device, *s.device, s.options.vpls, s.options.layout,
                                  renderer::light_atlas_options(s.options));
        case Method::antiradiance:
            return clgi::estimate(device, *s.scene, *s.device,
                                  renderer::antiradiance_options(s.options));
        case Method::dynamic_transfer:
            return clgi::estimate(device, *s.scene, *s.device,
                                  renderer::transfer_options(s.options));
        case Method::irradiance_cache:
            return clgi::estimate(device, *s.device, renderer::cache_options(s.options));
        default:
            return clgi::estimate(device, *s.device, renderer::second_order_options(s.options));
    }
}

void Renderer::build(bool samples) {
    state_->build();
    if (samples) state_->samples.build();
}

bool Renderer::prepare(const Progress& progress) {
    state_->shown = false;
    return state_->prepare(progress);
}

void Renderer::lights_changed() {
    state_->changed([](auto& method) { method.lights_changed(); });
}

void Renderer::geometry_changed(const WaitList& wait) {
    state_->changed([&](auto& method) { method.geometry_changed(wait); });
}

void Renderer::environment_changed() {
    state_->changed([](auto& method) { method.environment_changed(); });
}

void Renderer::reconfigure(const PictureOptions& picture) {
    State& s = *state_;
    if (!(picture.build == s.options.picture.build))
        throw Error("renderer: reconfigure(): build options are those of the constructor");
    RendererOptions wanted = s.options;
    wanted.picture = picture;
    if (s.made.index() > 0)
        s.of([&](auto& method) { method.reconfigure({s.programs, s.queue, *s.device, wanted}); });
    s.samples.forget();
    s.options = wanted;
}

cl::Event Renderer::render(const Camera& camera, const WaitList& wait) {
    State& s = *state_;
    s.begin_picture();
    s.drew(camera, s.sample(camera, 0, wait));
    s.finish_samples();
    return s.last;
}

cl::Event Renderer::refine() { return state_->refine(); }

bool Renderer::run(const Camera& camera, const Progress& progress) {
    State& s = *state_;
    build();
    if (SecondOrderSolver* solver = second_order()) {
        s.begin_picture();
        s.of([](auto& method) { method.sample(0); });
        if (!solver->run(camera, progress)) return false;
        s.of([&](auto& method) { method.add_passes(s.passes); });
        s.drew(camera, cl::Event());
        s.finish_samples();
        if (s.last()) s.last.wait();
        return true;
    }
    const bool done = s.prepared || prepare(progress);
    if (!s.prepared) return false;
    render(camera).wait();
    return done;
}

cl::Event Renderer::render(const Camera& camera, const GBuffer& given, const WaitList& wait) {
    State& s = *state_;
    s.build();
    SecondOrderSolver* solver = second_order();
    if (!solver)
        throw Error(std::string("renderer: a given G-buffer is lit by second-order illumination "
                                "alone, not by ") +
                    name_of(s.options.method));
    s.begin_picture();
    s.samples.forget();
    s.of([](auto& method) { method.sample(0); });
    s.last = solver->render(camera, given, wait);
    s.of([&](auto& method) { method.add_passes(s.passes); });
    return s.last;
}

const cl::Buffer& Renderer::radiance() const {
    const State& s = *state_;
    return s.samples.count() > 1 ? s.samples.mean() : s.radiance().planes;
}

std::uint32_t Renderer::stride() const { return state_->radiance().stride; }
double Renderer::sampling_error() const {
    const State& s = *state_;
    return s.samples.count() > 1 ? s.samples.error(s.pixels(), s.last)
                                 : std::numeric_limits<double>::infinity();
}
std::uint32_t Renderer::samples() const { return std::max(1u, state_->samples.count()); }

std::array<std::vector<float>, 3> Renderer::read_radiance() const {
    const State& s = *state_;
    const PictureOptions& picture = s.options.picture;
    status();  // the last picture is complete
    const WaitList wait = s.last() ? WaitList{s.last} : WaitList();
    std::array<std::vector<float>, 3> out;
    for (std::size_t c = 0; c < out.size(); ++c) {
        out[c].resize(static_cast<std::size_t>(picture.width) * picture.height);
        s.queue.enqueueReadBuffer(radiance(), CL_TRUE, c * stride() * sizeof(float),
                                  out[c].size() * sizeof(float), out[c].data(), &wait);
    }
    return out;
}

RendererStatus Renderer::status() const {
    return state_->of([](auto& method) { return method.status(); });
}

const std::vector<PassEvent>& Renderer::times() const { return state_->passes; }

std::size_t Renderer::bytes() const {
    return state_->samples.bytes() + state_->of([](auto& method) { return method.bytes(); });
}

std::size_t Renderer::bytes_with_scene() const { return bytes() + scene().bytes(); }

DeviceScene& Renderer::scene() { return *state_->device; }
const DeviceScene& Renderer::scene() const { return *state_->device; }
const RendererOptions& Renderer::options() const { return state_->options; }
std::pair<int, int> Renderer::size() const {
    return {state_->options.picture.width, state_->options.picture.height};
}

const EmitterSet& Renderer::emitters() const {
    return *state_->of([](auto& method) { return &method.emitters(); });
}

SecondOrderSolver* Renderer::second_order() const {
    const auto* method = std::get_if<std::unique_ptr<renderer::SecondOrder>>(&state_->made);
    return method ? &(*method)->solver : nullptr;
}

LightAtlasSolver* Renderer::light_atlas() const {
    const auto* method = std::get_if<std::unique_ptr<renderer::LightAtlas>>(&state_->made);
    return method ? (*method)->solver.get() : nullptr;
}

AntiradianceSolver* Renderer::antiradiance() const {
    const auto* method = std::get_if<std::unique_ptr<renderer::Antiradiance>>(&state_->made);
    return method ? &(*method)->solver : nullptr;
}

DynamicTransferSolver* Renderer::dynamic_transfer() const {
    const auto* method = std::get_if<std::unique_ptr<renderer::Transfer>>(&state_->made);
    return method ? &(*method)->solver : nullptr;
}

DynamicTransferView* Renderer::transfer_view() const {
    const auto* method = std::get_if<std::unique_ptr<renderer::Transfer>>(&state_->made);
    return method ? (*method)->view.get() : nullptr;
}

IrradianceCache* Renderer::irradiance_cache() const {
    const auto* method = std::get_if<std::unique_ptr<renderer::Cache>>(&state_->made);
    return method ? (*method)->solver.get() : nullptr;
}

std::optional<BakeSummary> Renderer::bake() const {
    const auto* method = std::get_if<std::unique_ptr<renderer::LightAtlas>>(&state_->made);
    if (!method) return std::nullopt;
    return (*method)->summary;
}

}  // namespace clgi
