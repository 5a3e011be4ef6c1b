// What a window shows is what a Renderer draws, however it was moved and lit on the way.
// SPDX-License-Identifier: MIT
#include "view/painter.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <clgi/options.hpp>
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
    explicit Watch(Subject subject)
        : painter(test::programs(), std::move(subject), options(), [this] { came(); }) {}

    static view::PainterOptions options() {
        view::PainterOptions out;
        out.width = width;
        out.height = height;
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
    return view::as_flags(out);
}

// The picture of a renderer that was made for what is shown.
io::Image truth(const Subject& subject, const Drawn& drawn) {
    const Scene scene = view::scene_of(subject, drawn.shown, width, height);
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
    out.set = 1;
    return out;
}

class PainterOfMethods : public testing::TestWithParam<Method> {};

TEST_P(PainterOfMethods, DrawsWhatARendererDraws) {
    const Subject subject = subject_of(cornell({LightSource::spot}));
    Watch watch(subject);
    Shown shown = by_hand(GetParam());
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
        Watch watch(subject);
        Shown shown = by_hand(method);
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
    Watch watch(subject);
    Shown shown = by_hand(Method::light_atlas);
    set_option(*shown.by_hand, "vpls", "3000");
    shown.viewpoint = view::viewpoint_of(subject.scene.cameras[0], bounds(subject.scene));
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
    EXPECT_GE(previews, 3u);
    const auto still = watch.finished(shown);
    ASSERT_TRUE(still);
    expect_same(still->picture, truth(subject, *still), 0.0);
}

TEST(Painter, SaysWhyAMethodDrawsNothing) {
    Watch watch(subject_of(cornell()));
    Shown shown = by_hand(Method::antiradiance);
    shown.by_hand->antiradiance.bins = 34;
    watch.painter.show(shown);
    watch.wait([&](const auto&) { return !watch.painter.status().trouble.empty(); });
    EXPECT_NE(watch.painter.status().trouble.find("bins"), std::string::npos)
        << watch.painter.status().trouble;
    // Another method is drawn all the same.
    shown = by_hand(Method::direct);
    shown.set = 2;
    EXPECT_TRUE(watch.finished(shown));
    EXPECT_EQ(watch.painter.status().trouble, "");
}

}  // namespace
}  // namespace clgi
