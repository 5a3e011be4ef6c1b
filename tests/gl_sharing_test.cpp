// Zero copy, as far as it can be tried on devices that cannot share: the decision by its facts, and
// all of the way by stand-ins for the driver's three entry points.
// SPDX-License-Identifier: MIT
#include <CL/cl_gl.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "gl/shared_images.hpp"
#include "gl/sharing.hpp"
#include "gl_drawing.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using gl::SharingFacts;

// All that has to be there, with an address for the OpenGL context.
SharingFacts fine() {
    static int context = 0;
    SharingFacts facts;
    facts.extensions = "cl_khr_fp64 cl_khr_gl_sharing cl_khr_icd";
    facts.images = true;
    facts.current = &context;
    facts.properties = {CL_CONTEXT_PLATFORM,
                        77,
                        CL_GL_CONTEXT_KHR,
                        reinterpret_cast<cl_context_properties>(&context),
                        CL_EGL_DISPLAY_KHR,
                        5,
                        0};
    return facts;
}

TEST(GlSharing, IsTakenWhereAllIsThere) {
    const gl::Sharing sharing = decide(fine());
    EXPECT_TRUE(sharing.zero_copy);
    EXPECT_EQ(sharing.reason, "zero copy: cl_khr_gl_sharing");
    EXPECT_FALSE(sharing.implicit);
    SharingFacts facts = fine();
    facts.extensions += " cl_khr_gl_event";
    EXPECT_TRUE(decide(facts).implicit);
}

TEST(GlSharing, SaysWhatIsMissing) {
    const auto expect_copied = [](SharingFacts facts, const std::string& reason) {
        const gl::Sharing sharing = decide(facts);
        EXPECT_FALSE(sharing.zero_copy);
        EXPECT_EQ(sharing.reason, "copied: " + reason);
    };
    SharingFacts facts = fine();
    facts.extensions = "cl_khr_gl_sharing_of_something_else cl_khr_gl_event";
    expect_copied(facts, "device does not list cl_khr_gl_sharing");
    facts = fine();
    facts.images = false;
    expect_copied(facts, "device has no images");
    for (const std::vector<cl_context_properties>& properties :
         {std::vector<cl_context_properties>(), {0}, {CL_CONTEXT_PLATFORM, CL_GL_CONTEXT_KHR, 0}}) {
        facts = fine();
        facts.properties = properties;
        expect_copied(facts, "OpenCL context was made without CL_GL_CONTEXT_KHR");
    }
    facts = fine();
    facts.current = &facts;
    expect_copied(facts, "OpenCL context was made for another OpenGL context than the current one");
    facts = fine();
    facts.missing = "clEnqueueAcquireGLObjects";
    expect_copied(facts, "OpenCL platform lacks clEnqueueAcquireGLObjects");
}

// ---- stand-ins for a driver ---------------------------------------------------------------------

struct Driver {
    std::vector<std::string> calls;
    std::vector<cl_mem> alive, acquired;
    unsigned refused = 0;  // a texture that cannot be shared
    cl_int acquire_error = CL_SUCCESS;
};
Driver driver;

// Called when an image is deleted.
void CL_CALLBACK deleted(cl_mem image, void*) {
    driver.alive.erase(std::remove(driver.alive.begin(), driver.alive.end(), image),
                       driver.alive.end());
}

// An image with a texture's texels instead of one on them.
cl_mem CL_API_CALL create(cl_context context, cl_mem_flags flags, cl_uint target, cl_int level,
                          cl_uint texture, cl_int* error) {
    EXPECT_EQ(flags, cl_mem_flags{CL_MEM_READ_ONLY});
    EXPECT_EQ(target, cl_uint{GL_TEXTURE_2D});
    EXPECT_EQ(level, 0);
    driver.calls.push_back("create");
    if (texture == driver.refused) {
        *error = CL_INVALID_GL_OBJECT;
        return nullptr;
    }
    GLint width = 0, height = 0, internal = 0;
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &internal);
    std::vector<float> texels(static_cast<std::size_t>(width * height) * 4);
    const bool whole = internal == GL_R32I, one = internal == GL_R32F;
    glGetTexImage(GL_TEXTURE_2D, 0,
                  whole ? GL_RED_INTEGER
                  : one ? GL_RED
                        : GL_RGBA,
                  whole ? GL_INT : GL_FLOAT, texels.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    const cl_image_format format = {cl_channel_order(whole || one ? CL_R : CL_RGBA),
                                    cl_channel_type(whole ? CL_SIGNED_INT32 : CL_FLOAT)};
    cl_image_desc shape{};
    shape.image_type = CL_MEM_OBJECT_IMAGE2D;
    shape.image_width = static_cast<std::size_t>(width);
    shape.image_height = static_cast<std::size_t>(height);
    const cl_mem image = clCreateImage(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, &format,
                                       &shape, texels.data(), error);
    if (image) {
        driver.alive.push_back(image);
        clSetMemObjectDestructorCallback(image, deleted, nullptr);
    }
    return image;
}

cl_int CL_API_CALL acquire(cl_command_queue queue, cl_uint count, const cl_mem* images,
                           cl_uint wait_count, const cl_event* wait, cl_event* event) {
    driver.calls.push_back("acquire " + std::to_string(count) + " after " +
                           std::to_string(wait_count));
    if (driver.acquire_error != CL_SUCCESS) return driver.acquire_error;
    driver.acquired.assign(images, images + count);
    return clEnqueueMarkerWithWaitList(queue, wait_count, wait, event);
}

cl_int CL_API_CALL release(cl_command_queue queue, cl_uint count, const cl_mem* images,
                           cl_uint wait_count, const cl_event* wait, cl_event* event) {
    driver.calls.push_back("release " + std::to_string(count) + " after " +
                           std::to_string(wait_count));
    EXPECT_EQ(std::vector<cl_mem>(images, images + count), driver.acquired);
    return clEnqueueMarkerWithWaitList(queue, wait_count, wait, event);
}

gl::Sharing stand_in() {
    gl::Sharing out;
    out.zero_copy = true;
    out.reason = "zero copy: by stand-ins";
    out.create = create;
    out.acquire = acquire;
    out.release = release;
    return out;
}

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
        const GBuffer out = test::marked_gbuffer(50 * 30);
        import.convert(test::device().queue, view_, *scene_, textures_, out).wait();
        return test::read_back(out, view_, *scene_);
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

TEST_F(GlSharedTextures, AreGivenUpAfterEveryConversion) {
    gl::GBufferImport shared(test::device().context, test::device().device, stand_in());
    for (int i = 0; i < 3; ++i) convert(shared);
    test::device().queue.finish();
    // A kernel may hold the images of its last launch.
    EXPECT_LE(driver.alive.size(), 6u);
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
