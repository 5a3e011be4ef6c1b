// Zero copy, as far as it can be tried on devices that cannot share: the decision by its analysis,
// and all of the way by stand-ins for the driver's three entry points.
// SPDX-License-Identifier: MIT
#include <CL/cl_gl.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "gl/shared_images.hpp"
#include "gl/sharing.hpp"
#include "gl_drawing.hpp"
#include "gl_stand_in.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using gl::SharingCapabilities;

// All that has to be there, with an address for the OpenGL context.
SharingCapabilities fine() {
    static int context = 0;
    SharingCapabilities analysis;
    analysis.extensions = "cl_khr_fp64 cl_khr_gl_sharing cl_khr_icd";
    analysis.images = true;
    analysis.current = &context;
    analysis.properties = {CL_CONTEXT_PLATFORM,
                           77,
                           CL_GL_CONTEXT_KHR,
                           reinterpret_cast<cl_context_properties>(&context),
                           CL_EGL_DISPLAY_KHR,
                           5,
                           0};
    return analysis;
}

TEST(GlSharing, IsTakenWhereAllIsThere) {
    const gl::Sharing sharing = decide(fine());
    EXPECT_TRUE(sharing.zero_copy);
    EXPECT_EQ(sharing.reason, "zero copy: cl_khr_gl_sharing");
    EXPECT_FALSE(sharing.implicit);
    SharingCapabilities analysis = fine();
    analysis.extensions += " cl_khr_gl_event";
    EXPECT_TRUE(decide(analysis).implicit);
}

TEST(GlSharing, SaysWhatIsMissing) {
    const auto expect_copied = [](SharingCapabilities analysis, const std::string& reason) {
        const gl::Sharing sharing = decide(analysis);
        EXPECT_FALSE(sharing.zero_copy);
        EXPECT_EQ(sharing.reason, "copied: " + reason);
    };
    SharingCapabilities analysis = fine();
    analysis.extensions = "cl_khr_gl_sharing_of_something_else cl_khr_gl_event";
    expect_copied(analysis, "device does not list cl_khr_gl_sharing");
    analysis = fine();
    analysis.images = false;
    expect_copied(analysis, "device has no images");
    for (const std::vector<cl_context_properties>& properties :
         {std::vector<cl_context_properties>(), {0}, {CL_CONTEXT_PLATFORM, CL_GL_CONTEXT_KHR, 0}}) {
        analysis = fine();
        analysis.properties = properties;
        expect_copied(analysis, "OpenCL context was made without CL_GL_CONTEXT_KHR");
    }
    analysis = fine();
    analysis.current = &analysis;
    expect_copied(analysis,
                  "OpenCL context was made for another OpenGL context than the current one");
    analysis = fine();
    analysis.missing = "clEnqueueAcquireGLObjects";
    expect_copied(analysis, "OpenCL platform lacks clEnqueueAcquireGLObjects");
}

using test::Driver;
using test::driver;
using test::stand_in;
using test::Texels;
using test::texels_of;

class GlSharedTextures : public test::Gl {
protected:
    void SetUp() override {
        test::Gl::SetUp();
        if (IsSkipped()) return;
        driver = Driver();
        scene_ = std::make_unique<DeviceScene>(test::on_device(cornell()));
        view_ = make_view(cornell().cameras[0], scene_->frame(), 50, 30);
        renderer_ = std::make_unique<gl::SceneRenderer>(test::device().queue, *scene_);
        renderer_->draw(view_);
        textures_ = renderer_->textures();
        textures_.ids = 0;  // RG32I, which few devices that cannot share have images for
    }

    test::Drawing convert(gl::GBufferImport& import) const {
        const GBuffer out = test::marked_gbuffer(view_.width * view_.height);
        import.convert(test::device().queue, view_, *scene_, textures_, out).wait();
        return test::read_back(out, view_, *scene_);
    }

    // Images made by one conversion, and images that exist after it.
    std::vector<long> made_and_alive(gl::GBufferImport& import) const {
        driver.calls.clear();
        convert(import);
        EXPECT_TRUE(import.zero_copy()) << import.path();
        test::device().queue.finish();
        return {std::count(driver.calls.begin(), driver.calls.end(), "create"),
                static_cast<long>(driver.alive.size())};
    }

    std::unique_ptr<DeviceScene> scene_;
    View view_{};
    std::unique_ptr<gl::SceneRenderer> renderer_;
    gl::GBufferTextures textures_;
};

const std::vector<std::string> all_shared = {
    "create",           "create", "create", "create", "create", "create", "acquire 6 after 0",
    "release 6 after 1"};

TEST_F(GlSharedTextures, GiveTheBitsOfCopiedOnes) {
    gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
    gl::GBufferImport copied(test::device().context, test::device().device, gl::Sharing());
    EXPECT_TRUE(shared.zero_copy());
    const test::Drawing a = convert(shared);
    EXPECT_TRUE(shared.zero_copy());
    EXPECT_EQ(shared.path(), "zero copy: by stand-ins");
    EXPECT_EQ(driver.calls, all_shared);
    const test::Drawing b = convert(copied);
    EXPECT_FALSE(copied.zero_copy());
    EXPECT_EQ(copied.path(), "copied: as asked for");
    EXPECT_EQ(a.planes, b.planes);
    EXPECT_EQ(a.ids, b.ids);
    EXPECT_EQ(driver.calls, all_shared);
}

// Gives a texture the size and texels of another one.
void specify(unsigned texture, unsigned from, GLenum internal) {
    const Texels texels = texels_of(from);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), texels.width, texels.height, 0,
                 texels.one ? GL_RED : GL_RGBA, GL_FLOAT, texels.values.data());
    glBindTexture(GL_TEXTURE_2D, 0);
}

using MadeAndAlive = std::vector<long>;

TEST_F(GlSharedTextures, AreMadeOnceAndSeeWhatIsDrawnLater) {
    {
        gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
        gl::GBufferImport copied(test::device().context, test::device().device, gl::Sharing());
        EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{6, 6}));
        for (int i = 0; i < 3; ++i) EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{0, 6}));
        const test::Drawing before = convert(shared);
        Camera aside = cornell().cameras[0];
        aside.position.x += 0.1;
        view_ = make_view(aside, scene_->frame(), 50, 30);
        renderer_->draw(view_);
        driver.calls.clear();
        const test::Drawing after = convert(shared);
        EXPECT_EQ(std::count(driver.calls.begin(), driver.calls.end(), "create"), 0);
        EXPECT_EQ(after.planes, convert(copied).planes);
        EXPECT_NE(after.planes, before.planes);
    }
    test::device().queue.finish();
    EXPECT_TRUE(driver.alive.empty()) << "the destructor releases them";
}

TEST_F(GlSharedTextures, AreMadeAnewWhereTheyChanged) {
    gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{6, 6}));
    unsigned names[6];
    glGenTextures(6, names);
    // Another name.
    specify(names[0], textures_.albedo, GL_RGBA32F);
    textures_.albedo = names[0];
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{1, 6}));
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{0, 6}));
    // The same name, another format.
    specify(names[0], names[0], GL_RGBA16F);
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{1, 6}));
    // No longer given, and given again.
    textures_.emission = 0;
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{0, 5}));
    textures_.emission = renderer_->textures().emission;
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{1, 6}));
    // The same names and formats, another width, another height.
    unsigned* const given[6] = {&textures_.albedo,    &textures_.position, &textures_.normal,
                                &textures_.geometric, &textures_.emission, &textures_.depth};
    const auto draw = [&](std::uint32_t width, std::uint32_t height) {
        view_ = make_view(cornell().cameras[0], scene_->frame(), width, height);
        renderer_->draw(view_);
        const gl::GBufferTextures& drawn = renderer_->textures();
        const unsigned from[6] = {drawn.albedo,    drawn.position, drawn.normal,
                                  drawn.geometric, drawn.emission, drawn.depth};
        for (int i = 0; i < 6; ++i) {
            specify(names[i], from[i], i == 5 ? GL_R32F : GL_RGBA32F);
            *given[i] = names[i];
        }
    };
    draw(50, 30);
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{6, 6}));
    draw(40, 30);
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{6, 6}));
    draw(40, 24);
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{6, 6}));
    // What cannot be seen from outside has to be said.
    draw(40, 24);
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{0, 6}));
    shared.forget_textures();
    EXPECT_EQ(made_and_alive(shared), (MadeAndAlive{6, 6}));
    glDeleteTextures(6, names);
}

TEST_F(GlSharedTextures, AreCopiedWhereOneCannotBeShared) {
    gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
    driver.refused = textures_.albedo;
    const test::Drawing a = convert(shared);
    EXPECT_FALSE(shared.zero_copy());
    EXPECT_EQ(shared.path(), "copied: albedo cannot be shared (OpenCL error " +
                                 std::to_string(CL_INVALID_GL_OBJECT) + ")");
    EXPECT_EQ(std::count(driver.calls.begin(), driver.calls.end(), "create"), 4);
    EXPECT_EQ(driver.calls.size(), 4u) << "nothing was acquired";
    EXPECT_TRUE(driver.alive.empty());
    driver.refused = 0;
    const test::Drawing b = convert(shared);
    EXPECT_TRUE(shared.zero_copy());
    EXPECT_EQ(a.planes, b.planes);
}

TEST_F(GlSharedTextures, AreCopiedWhereOpenClHasNoSuchImage) {
    const auto formats = gl::readable_formats(test::device().context);
    const bool two = std::any_of(formats.begin(), formats.end(), [](const cl::ImageFormat& f) {
        return f.image_channel_order == CL_RG && f.image_channel_data_type == CL_SIGNED_INT32;
    });
    if (two) GTEST_SKIP() << "the device has RG32I images";
    gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
    textures_.ids = renderer_->textures().ids;
    convert(shared);
    EXPECT_EQ(shared.path(), "copied: ids is RG32I, which OpenCL has no image format for here");
    EXPECT_TRUE(driver.calls.empty());
}

TEST_F(GlSharedTextures, AreHandedBackWhenTheKernelIsRefused) {
    gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
    GBuffer small = test::marked_gbuffer(50 * 30);
    small.ids = test::empty<cl_int>(7);
    EXPECT_THROW(shared.convert(test::device().queue, view_, *scene_, textures_, small), Error);
    EXPECT_EQ(driver.calls, all_shared);
    test::device().queue.finish();
    EXPECT_TRUE(driver.alive.empty());
}

TEST_F(GlSharedTextures, SayWhenTheyCannotBeAcquired) {
    gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
    driver.acquire_error = CL_OUT_OF_RESOURCES;
    try {
        convert(shared);
        ADD_FAILURE() << "converted";
    } catch (const DeviceError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "gl.import: textures cannot be acquired (OpenCL error " +
                      std::to_string(CL_OUT_OF_RESOURCES) + ")");
    }
    EXPECT_EQ(driver.calls.size(), 7u) << "neither kernel nor release";
}

TEST_F(GlSharedTextures, WaitForWhatTheyAreTold) {
    gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
    const cl::CommandQueue queue(test::device().context, test::device().device,
                                 CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    const GBuffer out = test::marked_gbuffer(50 * 30);
    test::device().queue.finish();
    cl::UserEvent gate(test::device().context);
    const cl::Event event = shared.convert(queue, view_, *scene_, textures_, out, {gate});
    EXPECT_EQ(driver.calls[6], "acquire 6 after 1");
    EXPECT_EQ(test::download<float>(out.planes, 1)[0], -77.0f);
    gate.setStatus(CL_COMPLETE);
    event.wait();
    EXPECT_NE(test::download<float>(out.planes, 1)[0], -77.0f);
}

TEST_F(GlSharedTextures, NeedEntryPoints) {
    gl::Sharing half = stand_in();
    half.release = nullptr;
    EXPECT_THROW(gl::GBufferImport(test::device().context, test::device().device, half), Error);
}

// Where a device can share, properties() makes a context in which it does.
TEST_F(GlSharedTextures, AreSharedForTrueWhereTheDeviceCan) {
    const auto properties = gl::sharing_properties(test::device().device);
    if (properties.empty()) {
        EXPECT_FALSE(gl::find_sharing(test::device().context, test::device().device).zero_copy);
        GTEST_SKIP() << "the device cannot share with this OpenGL";
    }
    const cl::Context context(test::device().device, properties.data());
    const cl::CommandQueue queue(context, test::device().device);
    const DeviceScene placed(context, test::device().device, cornell());
    gl::GBufferImport import(context, test::device().device);
    ASSERT_TRUE(import.zero_copy()) << import.path();
    const std::uint32_t stride = test::padded(50 * 30);
    const GBuffer out{cl::Buffer(context, CL_MEM_READ_WRITE, GBUFFER_PLANES * stride * 4),
                      cl::Buffer(context, CL_MEM_READ_WRITE, GBUFFER_ID_PLANES * stride * 4),
                      stride};
    import.convert(queue, view_, placed, textures_, out).wait();
    std::vector<float> planes(GBUFFER_PLANES * stride);
    queue.enqueueReadBuffer(out.planes, CL_TRUE, 0, planes.size() * 4, planes.data());
    gl::GBufferImport copied(test::device().context, test::device().device, gl::Sharing());
    const test::Drawing other = convert(copied);
    for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
        for (std::size_t p = 0; p < 50 * 30; ++p)
            ASSERT_EQ(planes[plane * stride + p], other.planes[plane * other.stride + p]);
}

}  // namespace
}  // namespace clgi
