// Pictures of a scene by any of the methods: what is made once, what follows a change, the picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/antiradiance_view.hpp>
#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/dynamic_transfer_view.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/light_atlas_view.hpp>
#include <clgi/advanced/vpl_layout.hpp>
#include <clgi/antiradiance.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/dynamic_transfer.hpp>
#include <clgi/irradiance_cache.hpp>
#include <clgi/light_atlas.hpp>
#include <clgi/programs.hpp>
#include <clgi/second_order.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace clgi {

enum class Method {
    direct,
    second_order,
    light_atlas,
    antiradiance,
    dynamic_transfer,
    irradiance_cache
};
// As in the program: "second-order". The other way round: none for any other word, such as "auto".
CLGI_API const char* name_of(Method method);
CLGI_API std::optional<Method> method_of(const std::string& name);

// Those of other methods than `method` are not read.
struct RendererOptions {
    Method method = Method::second_order;
    // Size, direct light with its shadow maps, and the build: of all methods. Solvers take them
    // from here, but a bake its emitters from light_atlas.emitters.
    PictureOptions picture;
    // Views of a picture, each through other points of its pixels and with light samples of its
    // own; the picture is their mean (box filter of a pixel). What is prepared, and the records of
    // an irradiance cache, serve all of them.
    int samples = 1;
    // Vertices move between pictures, as clip `clip` of the scene's animation says: the atlas bakes
    // what never moves and lights the rest by an irradiance volume; antiradiance makes its links
    // for `poses` poses of the clip. Dynamic transfer, second-order illumination and direct light
    // need nothing for it.
    bool animated = false;
    std::size_t clip = 0;
    int poses = 16;

    SecondOrderOptions second_order;  // but emitters: emitters.vpls alone is read
    VplOptions vpls;                  // of the light atlas
    AtlasOptions layout;
    LightAtlasOptions light_atlas;
    double least_change = 1e-3;  // LightAtlasSolver::update(), when lights have changed; 0: run()
    AntiradianceOptions antiradiance;
    DynamicTransferOptions transfer;
    DynamicTransferViewOptions transfer_view;  // but picture
    IrradianceCacheOptions cache;              // but picture
};

struct RendererStatus : SolverStatus {
    std::vector<std::string> warnings;  // sentences
};

// What a renderer of the light atlas has laid out before it bakes.
struct BakeSummary {
    std::size_t vpls = 0, texels = 0;
    int pages = 0, size = 0;  // texels, side of a page
    double layout_ms = 0.0;   // patches, VPLs and texels, on the host
};

// Works on the given queue (in order or not) and never finishes it, but waits where a method has to
// look at its own results: prepare() of the atlas and of antiradiance. One thread at a time.
//
//   Renderer renderer(queue, scene, options);
//   renderer.prepare();
//   cl::Event done = renderer.render(scene.cameras[0]);
class CLGI_API Renderer {
public:
    // Uploads the scene. Throws what DeviceScene does, and Error for options that the method does
    // not have.
    Renderer(const cl::CommandQueue& queue, const Scene& scene,
             const RendererOptions& options = {});

    // The same with kernels that others share.
    Renderer(const Programs& programs, const cl::CommandQueue& queue, const Scene& scene,
             const RendererOptions& options = {});

    // And with a scene that is on the device: what `scene` was uploaded
    // to, moved and lit by the caller. Both must outlive this object.
    Renderer(const Programs& programs, const cl::CommandQueue& queue, const Scene& scene,
             DeviceScene& device_scene, const RendererOptions& options = {});

    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Bytes that the method will allocate and milliseconds until its first picture, both about,
    // before build().
    Estimate estimate() const;

    // Makes solver and view: kernels, layouts, links, buffers. The first prepare() or render() does
    // it where this was not called. Throws what the solvers do. samples: with what refine() needs,
    // which its first call makes otherwise.
    void build(bool samples = false);

    // What precedes a picture: a bake, an exchange, transfer vectors and their light; after a
    // change of lights alone what follows from it. Waits for it, but for dynamic transfer and where
    // there is nothing to do. False if progress cancelled, or if the method has no result
    // (status()).
    bool prepare(const Progress& progress = nullptr);

    // After scene().set_light(): lights; after a SceneAnimator or SceneMover: vertices, when `wait`
    // has ended; after scene().turn_environment(): the environment. render() prepares anew where
    // that was not done since.
    void lights_changed();
    void geometry_changed(const WaitList& wait = {});
    void environment_changed();

    // Pictures of another size, with or without direct light, from now on; what was prepared stays.
    // Throws Error for options out of range and for build options other than the constructor's,
    // DeviceError when memory does not suffice; then pictures stay what they were.
    void reconfigure(const PictureOptions& picture);

    // Enqueues a picture that begins after `wait`; its event completes when all of it has.
    cl::Event render(const Camera& camera, const WaitList& wait = {});

    // Enqueues one more sample for the last picture, whose mean radiance() is then. The event
    // completes when it is in the mean. Throws Error before the first picture of a camera, and
    // after one from a given G-buffer.
    cl::Event refine();

    // prepare() and render(), waiting after each part to report. False as prepare(), and if
    // progress cancelled.
    bool run(const Camera& camera, const Progress& progress);

    // A picture from a given G-buffer (SecondOrderSolver::render). Throws Error for methods other
    // than direct and second_order.
    cl::Event render(const Camera& camera, const GBuffer& given, const WaitList& wait = {});

    const cl::Buffer& radiance() const;  // [RADIANCE_PLANES][stride()] cd/m^2, of the last picture
    std::uint32_t stride() const;        // floats between planes
    std::uint32_t samples() const;       // in the last picture
    // Waits for the last picture: how far its luminance may be from the mean of all samples, root
    // of the mean square over the mean. Taken from how far it is from the means of its first samples,
    // as many as the last two powers of two below their number; up to half of it at borders of
    // shadows, as four or more samples share their lights, and what all of them share is in none of
    // it. Infinite for one sample.
    double sampling_error() const;
    // Waits for the last picture: R, G and B, cd/m^2, [height * width] each.
    std::array<std::vector<float>, 3> read_radiance() const;

    RendererStatus status() const;                // waits for the last picture
    const std::vector<PassEvent>& times() const;  // of the last picture, and of what was prepared
                                                  // for it
    std::size_t bytes() const;                    // of the method's buffers, without the scene
    std::size_t bytes_with_scene() const;

    DeviceScene& scene();
    const DeviceScene& scene() const;
    const RendererOptions& options() const;
    std::pair<int, int> size() const;    // width and height of pictures
    const EmitterSet& emitters() const;  // of the picture's direct light

    // The method's own: null for others, and before build().
    SecondOrderSolver* second_order() const;
    LightAtlasSolver* light_atlas() const;
    AntiradianceSolver* antiradiance() const;
    DynamicTransferSolver* dynamic_transfer() const;
    DynamicTransferView* transfer_view() const;
    IrradianceCache* irradiance_cache() const;
    std::optional<BakeSummary> bake() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
