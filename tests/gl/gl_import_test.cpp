// Textures made by hand, handed in as an engine would.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "gl_drawing.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using GlImport = test::Gl;
using gl::GBufferTextures;
using test::GlTexture;

constexpr int width = 7, height = 5;

const DeviceScene& room() {
    static const DeviceScene placed = test::on_device(cornell());
    return placed;
}

View view_of_room() { return make_view(cornell().cameras[0], room().frame(), width, height); }

std::vector<float> filled(const glm::vec4& value) {
    std::vector<float> out;
    for (int i = 0; i < width * height; ++i)
        out.insert(out.end(), {value.x, value.y, value.z, value.w});
    return out;
}

// Floats at the wall of the room, in whatever format OpenGL is told to keep them.
struct Engine {
    explicit Engine(GLenum normals = GL_RGBA32F, GLenum colors = GL_RGBA32F)
        : position(GL_RGBA32F, width, height, GL_RGBA, GL_FLOAT, points().data()),
          normal(normals, width, height, GL_RGBA, GL_FLOAT, filled({0.25f, 0, -1, 0}).data()),
          albedo(colors, width, height, GL_RGBA, GL_FLOAT, filled({0.2f, 0.6f, 1, 0}).data()) {}

    static std::vector<float> points() {
        std::vector<float> out;
        for (int i = 0; i < width * height; ++i) {
            const float x = 0.05f * static_cast<float>(i % width);
            const float y = 0.05f * static_cast<float>(i / width);
            out.insert(out.end(), {x, y, 0.5f, 0.0f});
        }
        return out;
    }
    GBufferTextures textures() const {
        GBufferTextures out;
        out.position = position.name();
        out.normal = normal.name();
        out.albedo = albedo.name();
        return out;
    }

    GlTexture position, normal, albedo;
};

test::Drawing convert(const GBufferTextures& textures) {
    const GBuffer out = test::marked_gbuffer(width * height);
    const View view = view_of_room();
    test::shared_import().convert(test::device().queue, view, room(), textures, out).wait();
    return test::read_back(out, view, room());
}

TEST_F(GlImport, SaysWhichWayItTook) {
    const gl::GBufferImport import(test::device().context, test::device().device);
    const std::string extensions = test::device().device.getInfo<CL_DEVICE_EXTENSIONS>();
    if (extensions.find("cl_khr_gl_sharing") == std::string::npos) {
        EXPECT_EQ(import.path(), "copied: device does not list cl_khr_gl_sharing");
    }
    EXPECT_EQ(import.zero_copy(), import.path().rfind("zero copy: ", 0) == 0) << import.path();
    EXPECT_EQ(import.non_finite(), 0u);
}

TEST_F(GlImport, ReadsEveryFormatThatItNames) {
    const test::Drawing exact = convert(Engine().textures());
    ASSERT_NE(exact.at(GBUFFER_NORMAL, 0), glm::vec3(0.0f));
    for (const GLenum normals : {GL_RGBA16F, GL_RGBA32F})
        for (const GLenum colors : {GL_RGBA8, GL_RGBA16F, GL_RGBA32F}) {
            const test::Drawing got = convert(Engine(normals, colors).textures());
            // The last place of what the format keeps of 0.2 and 0.6: OpenGL may round or cut.
            const float step = colors == GL_RGBA8     ? 1.0f / 255.0f
                               : colors == GL_RGBA16F ? 0x1p-11f
                                                      : 0.0f;
            for (std::size_t p = 0; p < width * height; ++p) {
                // 0.25 and 1 are halves.
                EXPECT_EQ(got.at(GBUFFER_NORMAL, p), exact.at(GBUFFER_NORMAL, p));
                EXPECT_EQ(got.at(GBUFFER_POSITION, p), exact.at(GBUFFER_POSITION, p));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(got.at(GBUFFER_BASE, p)[c], exact.at(GBUFFER_BASE, p)[c], step);
            }
        }
}

TEST_F(GlImport, CountsRowsFromTheBottomAsOpenGlDoes) {
    const test::Drawing got = convert(Engine().textures());
    const SceneFrame& frame = room().frame();
    const glm::vec3 top = frame.to_local({0.0, 0.05 * (height - 1), 0.5});
    EXPECT_NEAR(got.at(GBUFFER_POSITION, 0).y, top.y, 1e-7f);
    const Engine engine;
    GBufferTextures turned = engine.textures();
    turned.top_first = true;
    EXPECT_EQ(convert(turned).at(GBUFFER_POSITION, 0),
              got.at(GBUFFER_POSITION, width * (height - 1)));
}

TEST_F(GlImport, AddsTheOriginInDoublePrecision) {
    const Engine engine;
    GBufferTextures moved = engine.textures();
    moved.origin = glm::dvec3(0.125, -0.25, 0.5);
    const glm::vec3 shift =
        convert(moved).at(GBUFFER_POSITION, 9) - convert(engine.textures()).at(GBUFFER_POSITION, 9);
    const auto scale = static_cast<float>(room().frame().scale);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(shift[c], scale * static_cast<float>(moved.origin[c]), 2e-7f);
}

TEST_F(GlImport, ReadsDepthEmissionAndIds) {
    const Engine engine;
    const std::vector<float> depths(width * height, 0.75f);
    const GlTexture depth(GL_R32F, width, height, GL_RED, GL_FLOAT, depths.data());
    const GlTexture glow(GL_RGBA16F, width, height, GL_RGBA, GL_FLOAT, filled({8, 4, 2, 0}).data());
    std::vector<cl_int> one, two;
    for (int i = 0; i < width * height; ++i) {
        one.push_back(i == 3 ? 1000000 : i % 3 - 1);
        two.insert(two.end(), {i % 3 - 1, i});
    }
    const GlTexture materials(GL_R32I, width, height, GL_RED_INTEGER, GL_INT, one.data());
    const GlTexture both(GL_RG32I, width, height, GL_RG_INTEGER, GL_INT, two.data());
    GBufferTextures textures = engine.textures();
    textures.top_first = true;
    textures.depth = depth.name();
    textures.emission = glow.name();
    textures.ids = materials.name();
    const test::Drawing a = convert(textures);
    textures.ids = both.name();
    const test::Drawing b = convert(textures);
    const SceneFrame& frame = room().frame();
    const auto triangles = static_cast<int>(room().info().triangle_count);
    for (int i = 0; i < width * height; ++i) {
        const auto p = static_cast<std::size_t>(i);
        EXPECT_EQ(a.depth(p), 0.75f * static_cast<float>(frame.scale));
        EXPECT_EQ(a.at(GBUFFER_EMISSION, p),
                  glm::vec3(8, 4, 2) / static_cast<float>(frame.exposure));
        EXPECT_EQ(a.ids[p], i == 3 ? -1 : i % 3 - 1);
        EXPECT_EQ(a.ids[a.stride + p], -1);
        EXPECT_EQ(b.ids[p], i % 3 - 1);
        EXPECT_EQ(b.ids[b.stride + p], i < triangles ? i : -1);
    }
}

TEST_F(GlImport, CountsTexelsThatAreNotFinite) {
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                         std::numeric_limits<float>::infinity()};
    const std::uint32_t before = test::shared_import().non_finite();
    Engine engine(GL_RGBA16F, GL_RGBA16F);
    for (int i = 0; i < 2; ++i)
        for (const GlTexture* texture : {&engine.position, &engine.normal, &engine.albedo}) {
            glBindTexture(GL_TEXTURE_2D, texture->name());
            const int column = 2 * i + (texture == &engine.normal), row = i;
            glTexSubImage2D(GL_TEXTURE_2D, 0, column, row, 1, 1, GL_RED, GL_FLOAT, &bad[i]);
        }
    glBindTexture(GL_TEXTURE_2D, 0);
    GBufferTextures textures = engine.textures();
    textures.top_first = true;
    const test::Drawing got = convert(textures);
    // Position and albedo share a texel.
    EXPECT_EQ(test::shared_import().non_finite() - before, 4u);
    for (const std::size_t p : {0, 1, width + 2, width + 3})
        EXPECT_EQ(got.at(GBUFFER_NORMAL, p), glm::vec3(0.0f)) << p;
    EXPECT_NE(got.at(GBUFFER_NORMAL, 2), glm::vec3(0.0f));
}

void expect_refused(const GBufferTextures& textures, const std::string& because) {
    try {
        convert(textures);
        ADD_FAILURE() << "accepted, though " << because;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
    }
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_F(GlImport, RefusesTexturesNamingWhatWasGotAndNeeded) {
    const Engine engine;
    const GBufferTextures whole = engine.textures();
    const auto changed = [&](unsigned GBufferTextures::*member, unsigned name) {
        GBufferTextures out = whole;
        out.*member = name;
        return out;
    };
    expect_refused(changed(&GBufferTextures::normal, 0), "normal is 0, a texture needed");
    expect_refused(changed(&GBufferTextures::albedo, 0), "albedo is 0, a texture needed");
    expect_refused(changed(&GBufferTextures::position, 0), "position and depth are both 0");
    expect_refused(changed(&GBufferTextures::emission, 12345),
                   "emission is 12345, which names no texture");

    const GlTexture small(GL_RGBA32F, 6, 5, GL_RGBA, GL_FLOAT, nullptr);
    expect_refused(changed(&GBufferTextures::normal, small.name()),
                   "normal is 6x5, 7x5 needed, the view's size");
    const GlTexture half(GL_RGBA16F, width, height, GL_RGBA, GL_FLOAT, nullptr);
    expect_refused(changed(&GBufferTextures::position, half.name()),
                   "position has the internal format RGBA16F, RGBA32F needed");
    const GlTexture rgb10(GL_RGB10_A2, width, height, GL_RGBA, GL_FLOAT, nullptr);
    expect_refused(changed(&GBufferTextures::albedo, rgb10.name()),
                   "albedo has the internal format 0x8059, RGBA8 or RGBA16F or RGBA32F needed");
    expect_refused(changed(&GBufferTextures::ids, half.name()), "R32I or RG32I needed");
    expect_refused(changed(&GBufferTextures::depth, half.name()), "R32F needed");

    GLuint cube = 0;
    glGenTextures(1, &cube);
    glBindTexture(GL_TEXTURE_CUBE_MAP, cube);
    expect_refused(changed(&GBufferTextures::geometric, cube),
                   "geometric is a texture of another kind, GL_TEXTURE_2D needed");
    glDeleteTextures(1, &cube);

    const View view = view_of_room();
    GBuffer narrow = test::marked_gbuffer(width * height);
    narrow.stride = 32;
    EXPECT_THROW(test::shared_import().convert(test::device().queue, view, room(), whole, narrow),
                 Error);
    // And goes on working.
    EXPECT_NE(convert(whole).at(GBUFFER_NORMAL, 0), glm::vec3(0.0f));
}

TEST_F(GlImport, TakesNoBlameForEarlierErrors) {
    const Engine engine;
    glEnable(GL_TEXTURE_CUBE_MAP_POSITIVE_X);  // which nobody can
    try {
        convert(engine.textures());
        ADD_FAILURE() << "converted";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()),
                  "gl.import: OpenGL error 0x0500 is pending from an earlier call");
    }
    EXPECT_NE(convert(engine.textures()).at(GBUFFER_NORMAL, 0), glm::vec3(0.0f));
}

TEST_F(GlImport, LeavesTheStateOfOpenGlAsItWas) {
    const Engine engine;
    const GlTexture other(GL_RGBA8, 2, 2, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glBindTexture(GL_TEXTURE_2D, other.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 8);
    glPixelStorei(GL_PACK_ROW_LENGTH, 99);
    glPixelStorei(GL_PACK_SKIP_ROWS, 3);
    const test::Drawing got = convert(engine.textures());
    EXPECT_NE(got.at(GBUFFER_NORMAL, 0), glm::vec3(0.0f));
    const auto value = [](GLenum name) {
        GLint out = 0;
        glGetIntegerv(name, &out);
        return static_cast<unsigned>(out);
    };
    EXPECT_EQ(value(GL_PIXEL_PACK_BUFFER_BINDING), buffer);
    EXPECT_EQ(value(GL_TEXTURE_BINDING_2D), other.name());
    EXPECT_EQ(value(GL_PACK_ALIGNMENT), 8u);
    EXPECT_EQ(value(GL_PACK_ROW_LENGTH), 99u);
    EXPECT_EQ(value(GL_PACK_SKIP_ROWS), 3u);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glPixelStorei(GL_PACK_SKIP_ROWS, 0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glDeleteBuffers(1, &buffer);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

// The event covers all of it, on a queue that keeps no order and behind work that is not done yet.
TEST_F(GlImport, WaitsForWhatItIsTold) {
    const Engine engine;
    const cl::CommandQueue queue(test::device().context, test::device().device,
                                 CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    cl::UserEvent gate(test::device().context);
    const GBuffer out = test::marked_gbuffer(width * height);
    test::device().queue.finish();
    gl::GBufferImport import(test::device().context, test::device().device);
    const cl::Event event =
        import.convert(queue, view_of_room(), room(), engine.textures(), out, {gate});
    EXPECT_NE(event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_COMPLETE);
    EXPECT_EQ(test::download<float>(out.planes, 1)[0], -77.0f);
    gate.setStatus(CL_COMPLETE);
    event.wait();
    EXPECT_NE(test::download<float>(out.planes, 1)[0], -77.0f);
}

// What a conversion waits for may fail long after the call.
TEST_F(GlImport, GoesOnAfterAConversionThatFailed) {
    const Engine engine;
    const cl::CommandQueue queue(test::device().context, test::device().device,
                                 CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    const GBuffer lost = test::marked_gbuffer(width * height);
    const GBuffer out = test::marked_gbuffer(width * height);
    test::device().queue.finish();
    gl::GBufferImport import(test::device().context, test::device().device, gl::Sharing());
    cl::UserEvent gate(test::device().context);
    const cl::Event event =
        import.convert(queue, view_of_room(), room(), engine.textures(), lost, {gate});
    gate.setStatus(CL_DEVICE_NOT_AVAILABLE);
    EXPECT_THROW(event.wait(), cl::Error);
    for (int i = 0; i < 2; ++i)
        import.convert(queue, view_of_room(), room(), engine.textures(), out).wait();
    EXPECT_NE(test::download<float>(out.planes, 1)[0], -77.0f);
    EXPECT_EQ(import.non_finite(), 0u);
}

// No context is current on a new thread, whether there is OpenGL or not.
TEST(GlContext, IsNeededAndSaidSo) {
    const auto refused = [](const std::function<void()>& call) {
        std::string text;
        std::thread([&] {
            try {
                call();
            } catch (const Error& error) {
                text = error.what();
            }
        }).join();
        EXPECT_NE(text.find("no OpenGL context is current on this thread, OpenGL 3.3 or later "
                            "needed"),
                  std::string::npos)
            << text;
    };
    const test::Device& on = test::device();
    refused([&] { gl::GBufferImport(on.context, on.device); });
    refused([&] { gl::GBufferImport(on.context, on.device, gl::Sharing()); });
    refused([&] { gl::SceneRenderer(on.queue, room()); });
    refused([&] { gl::sharing_properties(on.device); });
    refused([&] { gl::find_sharing(on.context, on.device); });
}

TEST_F(GlImport, MovesBetweenThreadsWithItsContext) {
    const Engine engine;
    const gl::HeadlessContext own;  // current from here on
    EXPECT_NE(own.description().find("OpenGL"), std::string::npos);
    EXPECT_THROW(convert(engine.textures()), Error) << "textures of another context";
    own.make_current();
    const Engine here;
    gl::GBufferImport import(test::device().context, test::device().device);
    const GBuffer out = test::marked_gbuffer(width * height);
    import.convert(test::device().queue, view_of_room(), room(), here.textures(), out).wait();
    EXPECT_NE(test::download<float>(out.planes, 1)[0], -77.0f);
}

}  // namespace
}  // namespace clgi
