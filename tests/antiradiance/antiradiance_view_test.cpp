// Pictures from elements: interpolation on known light, and closed rooms against the path tracer.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/planes.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <limits>

#include "apart.hpp"
#include "frames.hpp"
#include "math_modes.hpp"
#include "rooms.hpp"

namespace clgi {
namespace {

CLGI_IN_BOTH_MATHS(AntiradiancePicture);

constexpr int width = 96, height = 72;

// Two tilted squares that meet at a ridge, in front of a camera.
Scene roof(bool orthographic) {
    Scene scene = test::plain_scene();
    scene.materials[0].double_sided = true;
    test::add_quad(scene, {glm::dvec3(-1, 0, 1), {0, 0.4, 1}, {0, 0.4, -1}, {-1, 0, -1}});
    test::add_quad(scene, {glm::dvec3(0, 0.4, 1), {1, 0, 1}, {1, 0, -1}, {0, 0.4, -1}});
    scene.cameras = {test::camera_at({0.2, 2.6, 0.3}, {0, 0, 0}),
                     test::camera_at({0.2, -2.6, 0.3}, {0, 0, 0})};
    for (Camera& camera : scene.cameras) {
        if (!orthographic) continue;
        camera.kind = Camera::Kind::orthographic;
        camera.half_height = 1.2f;
    }
    // From below, along the front of the second square.
    const glm::dvec3 grazing(std::cos(glm::radians(-17.4)), std::sin(glm::radians(-17.4)), 0.0);
    if (orthographic) {
        scene.cameras.push_back(test::camera_at(3.0 * grazing, {0, 0, 0}));
        scene.cameras.back().kind = Camera::Kind::orthographic;
        scene.cameras.back().half_height = 1.2f;
    }
    return scene;
}

struct Shown {
    explicit Shown(const Scene& of, const AntiradianceOptions& options)
        : scene(test::on_device(of)),
          solver(test::programs(), test::device().queue, of, scene, options),
          view(test::programs(), test::device().queue, scene, solver, picture_options(options)) {}

    static PictureOptions picture_options(const AntiradianceOptions& options) {
        PictureOptions out;
        out.width = width;
        out.height = height;
        out.direct = false;
        out.build = options.build;
        return out;
    }
    std::vector<glm::vec3> planes(const cl::Buffer& buffer) const {
        return test::vectors(test::device().queue, buffer, view.picture().stride(),
                             std::size_t{width} * height);
    }

    DeviceScene scene;
    AntiradianceSolver solver;
    AntiradianceView view;
};

AntiradianceOptions options_of(Math math, std::size_t leaves) {
    AntiradianceOptions out;
    out.bins = 128;
    out.elements.requested = leaves;
    out.build.math = math;
    return out;
}

// Light that is a linear function of the place, another one on each side, is shown as it is: at
// every pixel, whatever the parts of the triangles. Less than nothing is shown as nothing.
TEST_P(AntiradiancePicture, InterpolatesLinearLightExactly) {
    for (const bool orthographic : {false, true}) {
        const Scene scene = roof(orthographic);
        Shown shown(scene, options_of(GetParam(), 300));
        shown.solver.run();
        const ElementTree& tree = shown.solver.elements();
        const auto patches =
            test::download<PatchCorners>(shown.solver.surface().patches, tree.count());
        const auto light_at = [](const glm::dvec3& at, double side) {
            return glm::vec3(side * (2.0 + at.x + 0.5 * at.z), 3.0 + at.y - at.x,
                             at.x + side * 0.1 * at.z);
        };
        std::vector<glm::vec4> light(shown.solver.surface().vertex_count);
        for (std::uint32_t i = 0; i < tree.count(); ++i) {
            if (!tree.is_leaf(i)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                // The corners of a back are wound against those of its front.
                const glm::dvec3& at = tree.corners[i][k];
                light[patches[i].vertex[k]] =
                    glm::vec4(light_at(at, tree.normals[i].y > 0.0 ? 1.0 : -1.0), 0.0f);
            }
        }
        test::device().queue.enqueueWriteBuffer(shown.solver.surface().light, CL_TRUE, 0,
                                                light.size() * sizeof(glm::vec4), light.data());
        for (const Camera& camera : scene.cameras) {
            shown.view.render(camera).wait();
            const auto found = shown.planes(shown.view.picture().irradiance());
            const auto seen = shown.planes(shown.view.picture().gbuffer().planes);
            const auto ids = test::download<cl_int>(
                shown.view.picture().gbuffer().ids,
                GBUFFER_ID_PLANES * std::size_t{shown.view.picture().stride()});
            int counted = 0, dark = 0;
            for (std::size_t p = 0; p < found.size(); ++p) {
                const int triangle = ids[GBUFFER_TRIANGLE * shown.view.picture().stride() + p];
                if (triangle < 0) {
                    EXPECT_EQ(found[p], glm::vec3(0.0f));
                    continue;
                }
                const SceneFrame& frame = shown.scene.frame();
                const glm::dvec3 at = glm::dvec3(seen[p]) / frame.scale + frame.origin;
                const bool second = shown.scene.triangle_order()[triangle] >= 2;
                const glm::dvec3 normal(second ? 0.4 : -0.4, 1.0, 0.0);
                const glm::dvec3 to_eye = camera.kind == Camera::Kind::orthographic
                                              ? -glm::dvec3(camera.forward)
                                              : camera.position - at;
                const double side = glm::dot(normal, to_eye) > 0.0 ? 1.0 : -1.0;
                const glm::vec3 wanted = light_at(at, side);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(found[p][c], std::max(wanted[c], 0.0f), 2e-5) << p;
                ++counted;
                if (wanted.x < 0.0f) ++dark;
            }
            EXPECT_GT(counted, 1000);
            EXPECT_EQ(dark > 0, camera.position.y < 0.0);
        }
    }
}

// A vertex has the mean of the leaves that meet there and face one way, by area.
TEST_P(AntiradiancePicture, VerticesHaveTheMeanOfTheirLeaves) {
    Shown shown(roof(false), options_of(GetParam(), 100));
    const ElementTree& tree = shown.solver.elements();
    const std::vector<std::uint32_t>& rows = shown.solver.leaf_elements();
    std::vector<glm::vec4> arrives(rows.size());
    for (std::size_t row = 0; row < rows.size(); ++row)
        arrives[row] = {std::sin(1.0 + row), std::cos(2.0 + row), 0.01 * row, 0.0};
    test::device().queue.enqueueWriteBuffer(shown.solver.leaves().irradiances, CL_TRUE, 0,
                                            arrives.size() * sizeof(glm::vec4), arrives.data());
    shown.solver.passes()
        .vertices(test::device().queue, shown.solver.surface(), shown.solver.leaves())
        .wait();
    const auto light = test::download<glm::vec4>(shown.solver.surface().light,
                                                 shown.solver.surface().vertex_count);
    const auto patches = test::download<PatchCorners>(shown.solver.surface().patches, tree.count());
    std::size_t most = 0;
    for (const std::uint32_t i : rows)
        for (std::size_t k = 0; k < 3; ++k) {
            glm::dvec3 sum(0.0);
            double area = 0.0;
            std::size_t around = 0;
            for (std::size_t row = 0; row < rows.size(); ++row) {
                const std::uint32_t other = rows[row];
                if (glm::dot(tree.normals[i], tree.normals[other]) < 0.9) continue;
                for (const glm::dvec3& corner : tree.corners[other])
                    if (glm::distance(corner, tree.corners[i][k]) < 1e-9) {
                        sum += tree.areas[other] * glm::dvec3(arrives[row]);
                        area += tree.areas[other];
                        ++around;
                    }
            }
            most = std::max(most, around);
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(light[patches[i].vertex[k]][c], sum[c] / area, 1e-6);
        }
    EXPECT_GE(most, 4u);
}

// Indirect light alone: root mean square error at most 20 % of the mean,
// energy within 5 %.
void expect_reference(Scene scene, const Camera& camera, const AntiradianceOptions& options = {},
                      double energy = 0.05) {
    scene.cameras = {camera};
    Shown shown(scene, options);
    ASSERT_TRUE(shown.solver.run());
    EXPECT_TRUE(shown.solver.status().converged);
    shown.view.render(camera).wait();
    EXPECT_EQ(shown.solver.status().non_finite + shown.view.picture().non_finite(), 0u);
    const auto found = shown.planes(shown.view.picture().radiance());
    reference::Options tracing;
    tracing.width = width;
    tracing.height = height;
    tracing.samples = 64;
    tracing.effects = reference::parse_effects("indirect");
    const test::Apart result = test::apart(found, test::render_twice(scene, camera, tracing));
    EXPECT_LT(result.high, 0.2);
    EXPECT_NEAR(result.energy, 1.0, energy);
    testing::Test::RecordProperty("rel_rmse", std::to_string(result.error));
    testing::Test::RecordProperty("energy", std::to_string(result.energy));
}

TEST(AntiradianceReference, FurnishedRooms) {
    const Camera camera = test::camera_at({0.15, 2.2, 2.85}, {2.4, 0.8, 1.2}, 1.1f);
    expect_reference(test::furnished_room(7), camera);
    expect_reference(test::furnished_room(11), camera);
}

// The dark one of two chambers, where all light comes through a slit: 128 bins blur its edge.
// It is 6 % too bright with 384 (docs/papers.md).
TEST(AntiradianceReference, TheChamberBehindASlit) {
    AntiradianceOptions options;
    options.bins = 384;
    expect_reference(test::chambers(), test::camera_at({3.9, 2.2, 0.2}, {2.2, 0.8, 2.2}, 1.1f),
                     options, 0.08);
}

}  // namespace
}  // namespace clgi
