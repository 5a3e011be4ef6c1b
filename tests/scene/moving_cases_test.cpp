// Geometry that moves: what emits, frames that no longer fit, queues out of order, wrong calls.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <array>
#include <limits>

#include "frames.hpp"
#include "scenes.hpp"
#include "turning.hpp"

namespace clgi {
namespace {

SecondOrderOptions tiny_frame() {
    SecondOrderOptions options;
    options.width = 96;
    options.height = 72;
    options.emitters = {.vpls = 120, .area_samples = 8};
    options.negative_vpls = 20;
    return options;
}

// A room with a lamp of many triangles, both sides of one of them glowing; vertices of the lamp
// come last.
struct Lantern {
    Scene scene;
    std::uint32_t first = 0;
};

Lantern lantern(const glm::dvec3& shift = glm::dvec3(0.0)) {
    Lantern out;
    Scene& scene = out.scene;
    scene = test::plain_scene();
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1);
    out.first = static_cast<std::uint32_t>(scene.positions.size());
    Material red, both;
    red.emission = glm::vec3(5.0f, 1.0f, 0.5f);
    both.emission = glm::vec3(1.0f, 2.0f, 9.0f);
    both.double_sided = true;
    test::add_box(scene, {-0.2, -0.1, -0.3}, {0.1, 0.2, 0.1}, 1, test::add_material(scene, red));
    test::add_triangle(scene, {0.4, 0.4, 0.4}, {0.6, 0.4, 0.4}, {0.4, 0.6, 0.3},
                       test::add_material(scene, both));
    for (std::size_t v = out.first; v < scene.positions.size(); ++v) scene.positions[v] += shift;
    scene.cameras.push_back(test::camera_at({0.7, 0.5, 0.9}, {-0.2, -0.1, -0.3}, 1.1f));
    return out;
}

void expect_same_emission(const DeviceScene& a, const DeviceScene& b) {
    ASSERT_EQ(a.emissive().size(), b.emissive().size());
    for (std::size_t i = 0; i < a.emissive().size(); ++i) {
        const EmissiveTriangle &x = a.emissive()[i], &y = b.emissive()[i];
        for (int k = 0; k < 3; ++k) EXPECT_EQ(x.corner[k], y.corner[k]) << i;
        EXPECT_EQ(x.normal, y.normal) << i;
        EXPECT_EQ(x.area, y.area) << i;
        EXPECT_EQ(x.radiance, y.radiance) << i;
    }
}

TEST(MovingEmission, GivesTheBitsOfAFreshLoad) {
    DeviceScene scene = test::on_device(lantern().scene);
    ASSERT_EQ(scene.emissive().size(), 14u);
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, tiny_frame());
    SceneMover mover(test::programs(), test::device().queue, scene);
    for (const glm::dvec3& shift : {glm::dvec3(0.3, -0.5, 0.2), glm::dvec3(-0.31, 0.1, -0.44)}) {
        Lantern moved = lantern(shift);
        mover.move(test::buffers_of(
            moved.scene, moved.first,
            static_cast<std::uint32_t>(moved.scene.positions.size()) - moved.first));
        solver.lights_changed();
        const DeviceScene fresh = test::on_device(moved.scene);
        expect_same_emission(scene, fresh);
        solver.render(moved.scene.cameras[0]).wait();
        EXPECT_TRUE(test::same_bits(
            test::read_frame(test::device().queue, scene, solver).radiance,
            test::render(moved.scene, moved.scene.cameras[0], tiny_frame()).radiance));
    }
}

// A triangle that loses its area shines no more, and shines again when it has one.
TEST(MovingEmission, MayVanishAndComeBack) {
    const Lantern rest = lantern();
    DeviceScene scene = test::on_device(rest.scene);
    SceneMover mover(test::programs(), test::device().queue, scene);
    Scene flat = rest.scene;
    const std::size_t last = flat.positions.size();
    flat.positions[last - 1] = flat.positions[last - 2];
    mover.move(static_cast<std::uint32_t>(last - 1), {flat.positions[last - 1]}, {});
    EXPECT_EQ(scene.emissive().size(), 12u);
    expect_same_emission(scene, test::on_device(flat));
    mover.move(static_cast<std::uint32_t>(last - 1), {rest.scene.positions[last - 1]}, {});
    expect_same_emission(scene, test::on_device(rest.scene));
}

TEST(MovingGeometry, TakesTheFrameOfAFreshLoadWhenRefitted) {
    const test::Turning turning = test::bunny();
    for (const bool from_host : {true, false}) {
        DeviceScene scene = test::on_device(turning.rest);
        SecondOrderSolver solver(test::programs(), test::device().queue, scene, tiny_frame());
        SceneMover mover(test::programs(), test::device().queue, scene);
        for (const double size : {3.7, 0.02}) {
            Scene world = turning.turned(size);
            for (glm::dvec3& p : world.positions) p = p * size + glm::dvec3(5, -3, 11);
            world.lights[0].position = world.lights[0].position * size + glm::dvec3(5, -3, 11);
            world.cameras[0].position = world.cameras[0].position * size + glm::dvec3(5, -3, 11);
            const auto all = static_cast<std::uint32_t>(world.positions.size());
            if (from_host) {
                mover.move(0, world.positions, world.normals, true);
            } else {
                MovedVertices moved = test::buffers_of(world, 0, all, {5, -3, 11});
                moved.refit = bounds(world);
                mover.move(moved);
            }
            EXPECT_TRUE(mover.status().fits);
            scene.set_light(0, world.lights[0]);
            solver.lights_changed();
            const DeviceScene fresh = test::on_device(world);
            EXPECT_EQ(scene.frame().origin, fresh.frame().origin);
            EXPECT_EQ(scene.frame().scale, fresh.frame().scale);
            EXPECT_EQ(scene.frame().radius, fresh.frame().radius);
            EXPECT_TRUE(test::same_bits(test::vertex_bits(scene), test::vertex_bits(fresh)));
            solver.render(world.cameras[0]).wait();
            EXPECT_TRUE(
                test::same_bits(test::read_frame(test::device().queue, scene, solver).radiance,
                                test::render(world, world.cameras[0], tiny_frame()).radiance));
        }
    }
}

// Frames and moves on a queue out of order, held together by events alone.
TEST(MovingGeometry, WaitsForWhatItIsToldOnAQueueOutOfOrder) {
    const test::Device& on = test::device();
    const cl::CommandQueue queue(on.context, on.device, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    const test::Turning turning = test::bunny();
    DeviceScene scene = test::on_device(turning.rest);
    SecondOrderSolver solver(test::programs(), queue, scene, tiny_frame());
    SceneMover mover(test::programs(), queue, scene);
    cl::UserEvent start(on.context);
    WaitList wait = {start};
    std::vector<Scene> scenes;
    std::vector<MovedVertices> moves;
    std::vector<cl::Buffer> pictures;
    const std::size_t floats = RADIANCE_PLANES * std::size_t{solver.stride()};
    for (int frame = 1; frame <= 5; ++frame) {
        scenes.push_back(turning.turned(0.2 * frame));
        moves.push_back(test::buffers_of(scenes.back(), turning.first, turning.count));
        wait = {mover.move(moves.back(), wait)};
        wait = {solver.render(scenes.back().cameras[0], wait)};
        pictures.push_back(test::empty<float>(floats));
        cl::Event copied;
        queue.enqueueCopyBuffer(solver.radiance(), pictures.back(), 0, 0, floats * sizeof(float),
                                &wait, &copied);
        wait = {copied};
    }
    queue.flush();
    start.setStatus(CL_COMPLETE);
    wait[0].wait();
    const std::size_t pixels = 96 * 72;
    for (std::size_t frame = 0; frame < 5; ++frame)
        EXPECT_TRUE(test::same_bits(
            test::vectors(on.queue, pictures[frame], solver.stride(), pixels),
            test::render(scenes[frame], scenes[frame].cameras[0], tiny_frame()).radiance))
            << frame;
    EXPECT_TRUE(mover.status().fits);
}

// `call` throws Error with all of `words` in its text.
void expect_refusal(const std::function<void()>& call, const std::vector<std::string>& words) {
    try {
        call();
        ADD_FAILURE() << "nothing was refused, " << words[0] << " was to be";
    } catch (const Error& error) {
        for (const std::string& word : words)
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

TEST(MovingGeometry, RefusesWhatDoesNotFitAndStaysAsItWas) {
    const Lantern rest = lantern();
    DeviceScene scene = test::on_device(rest.scene);
    const auto before = test::vertex_bits(scene);
    SceneMover mover(test::programs(), test::device().queue, scene);
    const auto all = static_cast<std::uint32_t>(rest.scene.positions.size());
    const cl::Buffer plenty = test::empty<glm::vec4>(all);
    const cl::Buffer short_by_one = test::empty<char>(16 * std::size_t{all} - 1);
    const std::string bytes = std::to_string(16 * all);
    const Bounds box = bounds(rest.scene);
    const Bounds other_box{box.low - 5.0, box.high};
    Bounds wrong = box;
    wrong.low.y = std::numeric_limits<double>::quiet_NaN();
    expect_refusal(
        [&] {
            mover.move({0, all, short_by_one, plenty, {}, {}});
        },
        {"scene.move", "positions", bytes});
    expect_refusal(
        [&] {
            mover.move({0, all, plenty, short_by_one, {}, other_box});
        },
        {"scene.move", "normals", bytes});
    expect_refusal([&] { mover.move({0, all, cl::Buffer(), plenty, {}, {}}); }, {"positions", "0"});
    expect_refusal([&] { mover.move({1, all, plenty, plenty, {}, {}}); }, {std::to_string(all)});
    expect_refusal([&] { mover.move({~0u, 2, plenty, plenty, {}, {}}); }, {std::to_string(all)});
    expect_refusal([&] { mover.move({0, all - 1, plenty, plenty, {}, box}); }, {"refit"});
    expect_refusal([&] { mover.move({0, all, plenty, plenty, {}, wrong}); }, {"refit", "box"});
    expect_refusal([&] { mover.move(0, {{0, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}); }, {"normals", "2"});
    std::vector<glm::dvec3> broken = rest.scene.positions;
    broken[3].z = std::numeric_limits<double>::infinity();
    expect_refusal([&] { mover.move(0, broken, {}, true); }, {"position 3", "not finite"});
    EXPECT_EQ(test::vertex_bits(scene), before);
    EXPECT_EQ(scene.frame().origin, test::on_device(rest.scene).frame().origin);

    const ScenePasses passes(test::programs());
    const cl::Buffer order = test::upload(scene.vertex_order());
    const cl::Buffer status = test::empty<cl_uint>(MOVE_STATUS_WORDS);
    const MoveParams params = move_params(scene, 0, all);
    const auto pass = [&](const MoveBuffers& buffers) {
        passes.move(test::device().queue, params, scene, buffers);
    };
    const std::size_t vertices = scene.info().vertex_count;
    expect_refusal(
        [&] {
            pass({test::empty<char>(4 * vertices - 1), plenty, plenty, status});
        },
        {"vertex_order", std::to_string(4 * vertices - 1)});
    expect_refusal([&] { pass({order, plenty, plenty, test::empty<char>(11)}); }, {"status", "12"});
    MoveParams other = params;
    other.vertex_count -= 1;
    EXPECT_THROW(passes.move(test::device().queue, other, scene, {order, plenty, plenty, status}),
                 Error);
}

TEST(MovingGeometry, KeepsTheSignOfZero) {
    Scene world = test::plain_scene();
    test::add_triangle(world, {-1, -1, -0.0}, {1, 1, -1}, {0, -0.0, 1});
    ASSERT_EQ(test::on_device(world).frame().origin, glm::dvec3(0.0));
    for (const bool from_host : {true, false}) {
        DeviceScene scene = test::on_device(world);
        const auto loaded = test::vertex_bits(scene);
        SceneMover mover(test::programs(), test::device().queue, scene);
        if (from_host)
            mover.move(0, world.positions, world.normals);
        else
            mover.move(test::buffers_of(world, 0, 3));
        EXPECT_EQ(test::vertex_bits(scene), loaded);
    }
}

TEST(MovingGeometry, LeavesVerticesWithoutTrianglesAlone) {
    Scene world = test::plain_scene();
    world.positions.assign(7, glm::dvec3(1e5));  // used by none
    world.normals.assign(7, glm::vec3(0, 1, 0));
    test::add_floor(world, 1.0);
    DeviceScene scene = test::on_device(world);
    EXPECT_EQ(scene.file_vertex_count(), 11u);
    EXPECT_EQ(scene.info().vertex_count, 4u);
    SceneMover mover(test::programs(), test::device().queue, scene);
    for (glm::dvec3& position : world.positions) position.x *= 0.5;
    mover.move(test::buffers_of(world, 0, 11)).wait();
    const MoveStatus status = mover.status();
    EXPECT_TRUE(status.fits);
    EXPECT_NEAR(status.farthest, std::sqrt(1.25), 1e-6);
    DeviceScene none = test::on_device(Scene());
    SceneMover idle(test::programs(), test::device().queue, none);
    idle.move(0, {}, {}, true).wait();
    EXPECT_EQ(idle.status().farthest, 0.0);
}

}  // namespace
}  // namespace clgi
