// clgi transfer: a floor's closed form in both files, their names and counts, poses, refusals.
// SPDX-License-Identifier: MIT
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "lab/transfer_vectors.hpp"
#include "program.hpp"
#include "transfer_scenes.hpp"

namespace {

using namespace clgi;
using nlohmann::json;

class TransferProgram : public test::Program {
protected:
    // A tilted quad above nothing, or a floor: nothing blocks anything.
    std::string save(const Scene& scene) const {
        const std::string path = file("given.glb").string();
        io::save_glb(scene, path);
        return path;
    }
    std::string exr() const { return file("out.exr").string(); }
    std::string glb() const { return file("out.glb").string(); }

    test::Outcome export_of(const std::string& scene, const std::string& flags = "") const {
        return run("transfer " + scene + " -o " + exr() + " " + flags);
    }
    json model_of(const std::string& path) const {
        std::ifstream in(path, std::ios::binary);
        std::uint32_t words[5];
        in.read(reinterpret_cast<char*>(words), sizeof(words));
        std::string text(words[3], ' ');
        in.read(text.data(), words[3]);
        return json::parse(text);
    }
    std::string binary_of(const std::string& path) const {
        std::ifstream in(path, std::ios::binary);
        std::stringstream text;
        text << in.rdbuf();
        std::uint32_t length = 0;
        std::memcpy(&length, text.str().data() + 12, 4);
        return text.str().substr(20 + length + 8);
    }
};

// The clamped cosine around the normal, in the file's own frame. Masks of 32 pixels lose nothing
// of an open sky: float rounding of 256 cells.
void expect_cosine(const io::Image& image, const std::string& prefix, std::size_t pixel,
                   const glm::dvec3& normal, int bands) {
    const std::vector<double> wanted = sh::around(normal, sh::cosine_kernel(bands));
    for (int l = 0; l < bands; ++l)
        for (int m = -l; m <= l; ++m) {
            const std::string name = prefix + "T." + std::to_string(l) + "." + std::to_string(m);
            const io::Image::Channel* channel = image.find(name);
            ASSERT_NE(channel, nullptr) << name;
            EXPECT_NEAR(channel->values[pixel], wanted[static_cast<std::size_t>(sh::index(l, m))],
                        2e-5)
                << name;
        }
}

Scene floor_scene(bool double_sided = false) {
    Scene scene = test::plain_scene();
    scene.materials[0].double_sided = double_sided;
    test::add_floor(scene, 2.0);
    return scene;
}

TEST_F(TransferProgram, WritesTheClampedCosineOfALoneFloor) {
    const test::Outcome outcome = export_of(save(floor_scene()));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("25 terms at 4 vertices,"), std::string::npos) << outcome.out;
    const io::Image image = io::load_image(exr());
    EXPECT_EQ(image.width, 4);
    EXPECT_EQ(image.height, 1);
    EXPECT_EQ(image.channels.size(), 25u);
    for (std::size_t v = 0; v < 4; ++v) expect_cosine(image, "", v, {0, 1, 0}, 5);
    // +Y is the middle one of the first degree, y, and not the polar axis.
    EXPECT_NEAR(image.find("T.1.-1")->values[0], std::sqrt(3 / (4 * M_PI)) * 2 * M_PI / 3, 2e-5);
    const std::map<std::string, std::string> wanted = {{"clgi:quantity", "transfer"},
                                                       {"clgi:unit", "sr"},
                                                       {"clgi:order", "4"},
                                                       {"clgi:terms", "25"},
                                                       {"clgi:window", "none"},
                                                       {"clgi:vertices", "4"},
                                                       {"clgi:mask", "32x32, cells of 2x2"}};
    for (const auto& [name, text] : wanted) EXPECT_EQ(image.attributes.at(name), text) << name;
    for (const char* name : {"clgi:basis", "clgi:frame", "clgi:meaning", "clgi:vertex_order"})
        EXPECT_FALSE(image.attributes.at(name).empty()) << name;
}

TEST_F(TransferProgram, WritesBothSidesOfATiltedSheet) {
    Scene scene = test::plain_scene();
    scene.materials[0].double_sided = true;
    const glm::dvec3 u = glm::normalize(glm::dvec3(1, 0.4, -0.2));
    const glm::dvec3 n = glm::normalize(glm::cross(u, glm::dvec3(0.1, 0.2, 1)));
    const glm::dvec3 v = glm::cross(n, u);
    test::add_quad(scene, {-u - v, u - v, u + v, v - u});
    const std::string gltf = glb();
    const test::Outcome outcome =
        export_of(save(scene), "--sh-order 2 --gltf " + gltf + " --stats " + file("s").string());
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const io::Image image = io::load_image(exr());
    EXPECT_EQ(image.channels.size(), 18u);
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
        expect_cosine(image, "", pixel, n, 3);
        expect_cosine(image, "back.", pixel, -n, 3);
    }
    const json stats = json::parse(read("s"));
    EXPECT_EQ(stats.at("receivers"), 8);
    EXPECT_EQ(stats.at("terms"), 9);
    EXPECT_EQ(stats.at("parts").at(0).at("vertex_count"), 4);
    const json attributes = model_of(gltf).at("meshes")[0].at("primitives")[0].at("attributes");
    for (const char* name : {"_TRANSFER_0", "_TRANSFER_2", "_TRANSFER_BACK_0", "_TRANSFER_BACK_2"})
        EXPECT_TRUE(attributes.contains(name)) << name;
    EXPECT_FALSE(attributes.contains("_TRANSFER_3"));
}

// A floor with a wall on it: vertices differ.
TEST_F(TransferProgram, WritesTheSameVectorsIntoTheGlb) {
    Scene scene = floor_scene(true);
    Material single;
    scene.materials.push_back(single);
    test::add_box(scene, {-0.5, 0.1, -0.5}, {0.5, 1.1, 0.5}, 1, 1);
    const std::string given = save(scene), gltf = glb();
    ASSERT_EQ(export_of(given, "--gltf " + gltf).code, 0) << read("err");
    const json model = model_of(gltf);
    EXPECT_EQ(model.at("asset").at("extras").at("clgi:unit"), "sr");
    EXPECT_EQ(model.at("asset").at("extras").at("clgi:terms"), "25");
    const Scene before = io::load_gltf(given), after = io::load_gltf(gltf);
    EXPECT_TRUE(after.warnings.empty()) << after.warnings.front();
    EXPECT_EQ(before.positions, after.positions);
    const io::Image image = io::load_image(exr());
    ASSERT_EQ(static_cast<std::size_t>(image.width), before.positions.size());
    // In the file's order, which is not the device's: the top of the box sees all of the sky.
    int tops = 0;
    for (std::size_t v = 0; v < before.positions.size(); ++v)
        if (before.positions[v].y > 1.0 && before.normals[v].y > 0.9f) {
            expect_cosine(image, "", v, {0, 1, 0}, 5);
            ++tops;
        } else if (before.normals[v].y < 0.5f) {
            EXPECT_LT(image.find("T.1.-1")->values[v], 0.7) << "the floor is below";
        }
    EXPECT_EQ(tops, 4);
    const std::string binary = binary_of(gltf);
    std::size_t vertex = 0, backs = 0;
    std::vector<double> squares(25, 0.0);
    for (const json& mesh : model.at("meshes"))
        for (const json& primitive : mesh.at("primitives")) {
            const json& attributes = primitive.at("attributes");
            const bool back = attributes.contains("_TRANSFER_BACK_0");
            EXPECT_EQ(back, primitive.at("material") == 0);
            backs += back;
            const std::size_t count = model.at("accessors")[attributes.at("POSITION").get<int>()]
                                          .at("count")
                                          .get<std::size_t>();
            for (int k = 0; k < 7; ++k) {
                const json& accessor = model.at(
                    "accessors")[attributes.at("_TRANSFER_" + std::to_string(k)).get<int>()];
                EXPECT_EQ(accessor.at("type"), "VEC4");
                EXPECT_EQ(accessor.at("componentType"), 5126);
                ASSERT_EQ(accessor.at("count"), count);
                const json& view = model.at("bufferViews")[accessor.at("bufferView").get<int>()];
                std::vector<float> values(4 * count);
                std::memcpy(values.data(), binary.data() + view.value("byteOffset", std::size_t{0}),
                            values.size() * sizeof(float));
                for (std::size_t v = 0; v < count; ++v)
                    for (int c = 0; c < 4; ++c) {
                        const int term = 4 * k + c, l = sh::degree(term);
                        const float found = values[4 * v + static_cast<std::size_t>(c)];
                        if (term >= 25) {
                            EXPECT_EQ(found, 0.0f) << "filled up";
                            continue;
                        }
                        const std::string name =
                            "T." + std::to_string(l) + "." + std::to_string(term - sh::index(l, 0));
                        EXPECT_EQ(found, image.find(name)->values[vertex + v]) << name;
                        squares[static_cast<std::size_t>(term)] += found * found;
                    }
            }
            vertex += count;
        }
    EXPECT_EQ(vertex, before.positions.size());
    EXPECT_EQ(backs, 1u);
    for (const double square : squares) EXPECT_GT(square, 1e-6) << "all terms say something";
}

TEST_F(TransferProgram, FollowsTheTimeOfAnAnimation) {
    const std::string scene = make("fight-like");
    ASSERT_EQ(export_of(scene, "--mask 16 --sh-order 2").code, 0) << read("err");
    const io::Image rest = io::load_image(exr());
    ASSERT_EQ(export_of(scene, "--mask 16 --sh-order 2 --time 1 --gltf " + glb()).code, 0)
        << read("err");
    const io::Image kick = io::load_image(exr());
    ASSERT_EQ(rest.width, kick.width);
    double apart = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < rest.channels.size(); ++i)
        for (std::size_t v = 0; v < rest.channels[i].values.size(); ++v) {
            apart += std::pow(rest.channels[i].values[v] - kick.channels[i].values[v], 2);
            whole += std::pow(rest.channels[i].values[v], 2);
        }
    EXPECT_GT(apart, 0.01 * whole);
    EXPECT_FALSE(model_of(glb()).contains("animations")) << "vectors are those of one pose";
}

TEST_F(TransferProgram, SimplifiesWhatBlocksFarAway) {
    const std::string scene = make("fight-like");
    const auto vectors = [&](const std::string& flags) {
        const test::Outcome outcome =
            export_of(scene, "--mask 16 " + flags + " --stats " + file("s").string());
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return io::load_image(exr());
    };
    const io::Image fine = vectors("");
    EXPECT_EQ(json::parse(read("s")).at("coarse_triangles"), 0);
    const double all = json::parse(read("s")).at("triangles_per_receiver");
    const io::Image coarse = vectors("--coarse 600 --rings 1");
    if (read("err").find("without clgi::mesh") != std::string::npos)
        GTEST_SKIP() << "clgi was built without clgi::mesh";
    const json stats = json::parse(read("s"));
    EXPECT_GE(stats.at("coarse_triangles"), 300);
    EXPECT_LT(stats.at("coarse_triangles"), 1500);
    EXPECT_LT(stats.at("triangles_per_receiver"), all / 2);
    double apart = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < fine.channels.size(); ++i)
        for (std::size_t v = 0; v < fine.channels[i].values.size(); ++v) {
            apart += std::pow(fine.channels[i].values[v] - coarse.channels[i].values[v], 2);
            whole += std::pow(fine.channels[i].values[v], 2);
        }
    EXPECT_GT(apart, 0.0);
    EXPECT_LT(apart, 0.02 * whole);
    EXPECT_EQ(
        run("render " + scene + " --method transfer --environment 1,1,1 --coarse 600 --size " +
            "32x24 -o " + exr())
            .code,
        0)
        << read("err");
}

TEST_F(TransferProgram, RefusesWhatItCannotDo) {
    const std::string scene = save(floor_scene()), o = " -o " + exr();
    const auto refused = [&](const std::string& arguments, int code, const std::string& words) {
        const test::Outcome outcome = run("transfer " + arguments);
        expect_one_error_line(outcome, code);
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(exr())) << arguments;
    };
    refused(scene, 1, "no output");
    refused(scene + " -o out.png", 1, "ends in .exr");
    refused(scene + o + " --gltf out.gltf", 1, "ends in .glb");
    refused(scene + o + " --sh-order 9", 1, "--sh-order");
    refused(scene + o + " --mask 20", 1, "--mask");
    refused(scene + o + " --quiet --rings 1", 1, "--rings goes only with --coarse");
    refused(scene + o + " --quiet --time 1", 1, "no animation");
    refused(file("none.glb").string() + o, 2, "none.glb");
    refused(scene + " --quiet -o " + file("no/folder/out.exr").string(), 2, "no/folder");
    refused(scene + o + " --device nobody:CPU:0", 3, "nobody");
    Scene empty = floor_scene();
    empty.triangles.clear();
    empty.positions.clear();
    empty.normals.clear();
    empty.cameras = {test::camera_at({0, 1, 3}, {0, 0, 0}, 1.0f)};
    refused(save(empty) + o, 2, "no triangles");
    EXPECT_EQ(run("render " + scene + " -o " + exr() + " --coarse 100").code, 1);
}

TEST(TransferImage, WrapsRowsAndLeavesTheRestBlack) {
    lab::TransferVectors vectors;
    vectors.bands = 1;
    vectors.vertices = 5000;
    vectors.front.assign(1, lab::Plane(5000));
    for (std::size_t v = 0; v < 5000; ++v) vectors.front[0][v] = 1.0f + static_cast<float>(v);
    const io::Image image = lab::transfer_image(vectors);
    EXPECT_EQ(image.width, 4096);
    EXPECT_EQ(image.height, 2);
    ASSERT_EQ(image.channels.size(), 1u);
    ASSERT_EQ(image.channels[0].values.size(), 8192u);
    EXPECT_EQ(image.channels[0].values[4096 + 903], 5000.0f);
    EXPECT_EQ(image.channels[0].values[4096 + 904], 0.0f);
}

TEST(VertexAttributes, AreCheckedBeforeAnythingIsWritten) {
    const Scene scene = floor_scene();
    const std::string path =
        (std::filesystem::temp_directory_path() / "clgi_attributes_test.glb").string();
    const auto refused = [&](const std::vector<io::VertexAttribute>& attributes,
                             const std::string& words) {
        try {
            io::save_glb(scene, path, {attributes, {}});
            ADD_FAILURE() << words;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(path));
    };
    const std::vector<glm::vec4> four(4), three(3), bad(4, glm::vec4(0, NAN, 0, 0));
    refused({{"TRANSFER", four}}, "underscore");
    refused({{"_A", four}, {"_A", four}}, "two attributes");
    refused({{"_A", three}}, "3 values");
    refused({{"_A", bad}}, "not finite");
}

}  // namespace
