// What a window shows is what a Renderer draws, however it was moved and lit on the way.
// SPDX-License-Identifier: MIT
#include "view/painter.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <clgi/advanced/animation.hpp>
#include <clgi/options.hpp>
#include <clgi/plan.hpp>
#include <clgi/procedural.hpp>
#include <condition_variable>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <mutex>

#include "device.hpp"
#include "lab/preview.hpp"

namespace clgi {
namespace {

using view::Drawn;
using view::Painter;
using view::Shown;
using view::Subject;

constexpr int width = 64, height = 48;

// Waits, a minute at most, for what a painter draws.
class Watch {
public:
    Watch(Subject subject, const Shown& first)
        : painter(test::programs(), std::move(subject), first, options(), [this] { came(); }) {}

    static view::PainterOptions options() {
        view::PainterOptions out;
        out.width = width;
        out.height = height;
        out.check_seconds = 0.1;
        return out;
    }

    using Wanted = std::function<bool(const std::shared_ptr<const Drawn>&)>;
    std::shared_ptr<const Drawn> wait(const Wanted& wanted) {
        std::unique_lock lock(mutex_);
        std::shared_ptr<const Drawn> last;
        const bool came = changed_.wait_for(lock, std::chrono::minutes(1), [&] {
            last = painter.drawn();
            return wanted(last);
        });
        EXPECT_TRUE(came);
        return came ? last : nullptr;
    }

    // A finished picture of this.
    std::shared_ptr<const Drawn> finished(const Shown& shown) {
        painter.show(shown);
        return wait([&](const auto& drawn) {
            return drawn && drawn->check && drawn->shown.version() == shown.version();
        });
    }

private:
    void came() {
        const std::lock_guard lock(mutex_);
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;

public:
    Painter painter;
};

Subject subject_of(Scene scene) {
    Subject out;
    out.scene = std::move(scene);
    out.flags = "scene.glb";
    return out;
}

RendererOptions small(Method method) {
    RendererOptions out;
    out.method = method;
    out.picture.width = width;
    out.picture.height = height;
    out.picture.emitters.shadow_size = out.light_atlas.emitters.shadow_size = 128;
    out.vpls.count = 40;
    out.layout.size = 64;
    out.light_atlas.hemicube_size = 64;
    out.second_order.emitters.vpls = 50;
    out.antiradiance.elements.requested = 300;
    out.cache.seen = 60;
    out.cache.met = out.cache.refined = 40;
    return view::as_flags(out);
}

// The picture of a renderer that was made for what is shown.
io::Image truth(const Subject& subject, const Drawn& drawn) {
    Scene scene = view::scene_of(subject, drawn.shown);
    scene.focus = focus_of(scene, scene.cameras[subject.camera], width, height);
    DeviceScene device_scene = test::on_device(scene);
    Renderer renderer(test::programs(), test::device().queue, scene, device_scene, drawn.options);
    renderer.prepare();
    renderer.render(scene.cameras[subject.camera]).wait();
    return lab::radiance_picture(renderer);
}

void expect_same(const io::Image& found, const io::Image& wanted, double share) {
    double difference = 0.0, sum = 0.0;
    for (const char* name : {"R", "G", "B"}) {
        const std::vector<float>&a = found.find(name)->values, &b = wanted.find(name)->values;
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            difference = std::max(difference, double{std::abs(a[i] - b[i])});
            sum += double{b[i]} / (3.0 * width * height);
        }
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_LE(difference, share * sum);
}

Shown by_hand(Method method) {
    Shown out;
    out.method = method;
    out.by_hand = small(method);
    return out;
}

class PainterOfMethods : public testing::TestWithParam<Method> {};

TEST_P(PainterOfMethods, DrawsWhatARendererDraws) {
    const Subject subject = subject_of(cornell({LightSource::spot}));
    Shown shown = by_hand(GetParam());
    Watch watch(subject, shown);
    const auto first = watch.finished(shown);
    ASSERT_TRUE(first);
    EXPECT_FALSE(first->preview);
    EXPECT_GE(first->options.samples, 4);
    expect_same(first->picture, truth(subject, *first), 0.0);

    // From elsewhere, by another light: what was prepared is brought up to date.
    shown.viewpoint = view::Viewpoint{{0.2, 0.4, -0.6}, {0.3, 0.2, 0.3}};
    ++shown.moved;
    Light light = subject.scene.lights[0];
    light.intensity *= glm::vec3(0.5f, 2.0f, 1.5f);
    light.position.x += 0.05;
    shown.lights[0] = light;
    ++shown.lit;
    const auto second = watch.finished(shown);
    ASSERT_TRUE(second);
    expect_same(second->picture, truth(subject, *second), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Methods, PainterOfMethods,
                         testing::Values(Method::direct, Method::second_order, Method::light_atlas,
                                         Method::antiradiance, Method::irradiance_cache),
                         [](const auto& of) {
                             std::string out = name_of(of.param);
                             std::erase(out, '-');
                             return out;
                         });

// A room under a sky whose sides differ; only the sky lights it.
Subject under_a_sky() {
    Scene scene = cornell({LightSource::spot});
    scene.lights.clear();
    Environment sky;
    sky.width = 4;
    sky.height = 2;
    for (const float x : {1.0f, 2.0f, 6.0f, 3.0f, 0.2f, 0.5f, 0.1f, 0.4f})
        sky.texels.emplace_back(x, 0.8f * x, 1.5f - 0.2f * x);
    scene.environment = sky;
    Subject out = subject_of(std::move(scene));
    out.scene.environment->rotation = static_cast<float>(glm::radians(40.0));
    out.turned = 40.0;
    return out;
}

TEST(Painter, TurnsTheSky) {
    for (const Method method : {Method::second_order, Method::antiradiance}) {
        const Subject subject = under_a_sky();
        Shown shown = by_hand(method);
        shown.turn = 60.0;
        Watch watch(subject, shown);
        const auto first = watch.finished(shown);
        shown.turn = 100.0;
        ++shown.lit;
        const auto second = watch.finished(shown);
        ASSERT_TRUE(first && second);
        expect_same(first->picture, truth(subject, *first), 0.0);
        expect_same(second->picture, truth(subject, *second), 2e-3);
        EXPECT_NE(first->picture.find("R")->values, second->picture.find("R")->values);
    }
}

// Cameras that move meanwhile get pictures at once, and do not end what serves all of them.
TEST(Painter, DrawsWhileItBakes) {
    const Subject subject = subject_of(cornell());
    Shown shown = by_hand(Method::light_atlas);
    set_option(*shown.by_hand, "vpls", "3000");
    shown.viewpoint = view::viewpoint_of(subject.scene.cameras[0], bounds(subject.scene));
    Watch watch(subject, shown);
    std::size_t previews = 0, moves = 0;
    for (bool baked = false; !baked; ++moves) {
        view::orbit(*shown.viewpoint, 0.002, 0.0);
        ++shown.moved;
        watch.painter.show(shown);
        const auto drawn = watch.wait(
            [&](const auto& last) { return last && last->shown.version() >= shown.version(); });
        ASSERT_TRUE(drawn);
        previews += drawn->preview;
        baked = drawn->options.method == Method::light_atlas;
    }
    EXPECT_GE(previews, 1u);
    const auto still = watch.finished(shown);
    ASSERT_TRUE(still);
    expect_same(still->picture, truth(subject, *still), 0.0);
}

TEST(Painter, SaysWhyAMethodDrawsNothing) {
    Shown shown = by_hand(Method::antiradiance);
    shown.by_hand->antiradiance.bins = 34;
    Watch watch(subject_of(cornell()), shown);
    watch.wait([&](const auto&) { return !watch.painter.status().trouble.empty(); });
    EXPECT_NE(watch.painter.status().trouble.find("bins"), std::string::npos)
        << watch.painter.status().trouble;
    // Another method is drawn all the same.
    shown = by_hand(Method::direct);
    shown.set = 1;
    EXPECT_TRUE(watch.finished(shown));
    EXPECT_EQ(watch.painter.status().trouble, "");
}

// A box that moves, with a light and a camera that are carried.
TEST(Painter, PosesWhatNodesCarry) {
    Scene scene = cornell({LightSource::spot});
    scene.lights[0].kind = Light::Kind::point;
    Animation motion;
    AnimatedNode node;
    const glm::dvec3 starts[] = {scene.lights[0].position, scene.cameras[0].position};
    motion.nodes = {node, node};
    for (int n = 0; n < 2; ++n) motion.nodes[n].translation = starts[n];
    motion.nodes[1].rotation = glm::dquat(0.0, 0.0, 1.0, 0.0);  // cameras look along -Z
    AnimationClip clip;
    clip.duration = 1.0;
    clip.curves.resize(2);
    for (std::uint32_t n = 0; n < 2; ++n) {
        clip.curves[n].times = {0.0f, 1.0f};
        clip.curves[n].components = 3;
        const glm::vec3 from(starts[n]),
            to = from + glm::vec3(n == 0 ? -0.1f : 0.05f, 0.0f, n == 0 ? 0.1f : -0.1f);
        clip.curves[n].values = {from.x, from.y, from.z, to.x, to.y, to.z};
        clip.channels.push_back({ChannelTarget::translation, n, n});
    }
    motion.clips = {clip};
    motion.lights = {{0, 0}};
    motion.cameras = {{0, 1}};
    scene.animation = motion;
    const Subject subject = subject_of(std::move(scene));

    Shown shown = by_hand(Method::direct);
    Watch watch(subject, shown);
    const auto rest = watch.finished(shown);
    shown.seconds = 1.0;
    ++shown.posed;
    const auto posed = watch.finished(shown);
    ASSERT_TRUE(rest && posed);
    EXPECT_NEAR(posed->camera.position.z - rest->camera.position.z, -0.1, 1e-6);
    EXPECT_NEAR(posed->lights[0].position.x - rest->lights[0].position.x, -0.1, 1e-6);
    expect_same(posed->picture, truth(subject, *posed), 0.0);

    // The preview shows the same pose, and a light that was moved by hand stays.
    Light light = posed->lights[0];
    light.intensity *= 0.5f;
    shown.lights[0] = light;
    ++shown.lit;
    shown.seconds = 0.5;
    ++shown.posed;
    watch.painter.show(shown);
    const auto preview =
        watch.wait([&](const auto& drawn) { return drawn->shown.version() == shown.version(); });
    ASSERT_TRUE(preview);
    EXPECT_EQ(preview->lights[0].position, light.position);
    EXPECT_EQ(preview->lights[0].intensity, light.intensity);
    EXPECT_NEAR(preview->camera.position.z - rest->camera.position.z, -0.05, 1e-6);
}

}  // namespace
}  // namespace clgi
