// A driver that shares textures, played by functions in place of its three entry points. Its images
// have memory of their own, which acquiring fills with what the textures hold then.
// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <clgi/gl/sharing.hpp>
#include <map>
#include <string>
#include <vector>

#include "device.hpp"

namespace clgi::test {

struct Driver {
    std::vector<std::string> calls;
    std::vector<cl_mem> alive, acquired;
    std::map<cl_mem, unsigned> textures;  // of images
    unsigned refused = 0;                 // a texture that cannot be shared
    cl_int acquire_error = CL_SUCCESS;
};
inline Driver driver;

// Called when an image is deleted.
inline void CL_CALLBACK deleted(cl_mem image, void*) {
    driver.alive.erase(std::remove(driver.alive.begin(), driver.alive.end(), image),
                       driver.alive.end());
}

// Level 0 of a texture, as floats or integers.
struct Texels {
    std::vector<float> values;
    GLint width = 0, height = 0;
    bool whole = false, one = false;  // integers; one channel
};

inline Texels texels_of(unsigned texture) {
    Texels out;
    GLint internal = 0;
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &out.width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &out.height);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &internal);
    out.values.resize(static_cast<std::size_t>(out.width * out.height) * 4);
    out.whole = internal == GL_R32I;
    out.one = internal == GL_R32F;
    glGetTexImage(GL_TEXTURE_2D, 0,
                  out.whole ? GL_RED_INTEGER
                  : out.one ? GL_RED
                            : GL_RGBA,
                  out.whole ? GL_INT : GL_FLOAT, out.values.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    return out;
}

// An image of its own in place of one on the texture's texels, which acquire() brings over.
inline cl_mem CL_API_CALL create(cl_context context, cl_mem_flags flags, cl_uint target,
                                 cl_int level, cl_uint texture, cl_int* error) {
    EXPECT_EQ(flags, cl_mem_flags{CL_MEM_READ_ONLY});
    EXPECT_EQ(target, cl_uint{GL_TEXTURE_2D});
    EXPECT_EQ(level, 0);
    driver.calls.push_back("create");
    if (texture == driver.refused) {
        *error = CL_INVALID_GL_OBJECT;
        return nullptr;
    }
    const Texels texels = texels_of(texture);
    const cl_image_format format = {cl_channel_order(texels.whole || texels.one ? CL_R : CL_RGBA),
                                    cl_channel_type(texels.whole ? CL_SIGNED_INT32 : CL_FLOAT)};
    cl_image_desc shape{};
    shape.image_type = CL_MEM_OBJECT_IMAGE2D;
    shape.image_width = static_cast<std::size_t>(texels.width);
    shape.image_height = static_cast<std::size_t>(texels.height);
    const cl_mem image = clCreateImage(context, CL_MEM_READ_ONLY, &format, &shape, nullptr, error);
    if (image) {
        driver.alive.push_back(image);
        driver.textures[image] = texture;
        clSetMemObjectDestructorCallback(image, deleted, nullptr);
    }
    return image;
}

inline cl_int CL_API_CALL acquire(cl_command_queue queue, cl_uint count, const cl_mem* images,
                                  cl_uint wait_count, const cl_event* wait, cl_event* event) {
    driver.calls.push_back("acquire " + std::to_string(count) + " after " +
                           std::to_string(wait_count));
    if (driver.acquire_error != CL_SUCCESS) return driver.acquire_error;
    driver.acquired.assign(images, images + count);
    for (const cl_mem image : driver.acquired) {
        const Texels texels = texels_of(driver.textures.at(image));
        std::size_t width = 0, height = 0;
        clGetImageInfo(image, CL_IMAGE_WIDTH, sizeof width, &width, nullptr);
        clGetImageInfo(image, CL_IMAGE_HEIGHT, sizeof height, &height, nullptr);
        EXPECT_EQ(width, static_cast<std::size_t>(texels.width));
        EXPECT_EQ(height, static_cast<std::size_t>(texels.height));
        const std::size_t first[3] = {0, 0, 0}, size[3] = {width, height, 1};
        EXPECT_EQ(clEnqueueWriteImage(device().queue(), image, CL_TRUE, first, size, 0, 0,
                                      texels.values.data(), 0, nullptr, nullptr),
                  CL_SUCCESS);
    }
    return clEnqueueMarkerWithWaitList(queue, wait_count, wait, event);
}

inline cl_int CL_API_CALL release(cl_command_queue queue, cl_uint count, const cl_mem* images,
                                  cl_uint wait_count, const cl_event* wait, cl_event* event) {
    driver.calls.push_back("release " + std::to_string(count) + " after " +
                           std::to_string(wait_count));
    EXPECT_EQ(std::vector<cl_mem>(images, images + count), driver.acquired);
    return clEnqueueMarkerWithWaitList(queue, wait_count, wait, event);
}

inline gl::Sharing stand_in() {
    gl::Sharing out;
    out.zero_copy = true;
    out.reason = "zero copy: by stand-ins";
    out.create = create;
    out.acquire = acquire;
    out.release = release;
    return out;
}

}  // namespace clgi::test
