// SPDX-License-Identifier: MIT
#include "gl/shared_images.hpp"

#include <algorithm>
#include <clgi/error.hpp>

namespace clgi::gl {
namespace {

std::vector<cl_mem> objects_of(const ImportImages& images) {
    std::vector<cl_mem> out;
    for (const cl::Image2D* image :
         {&images.position, &images.normal, &images.geometric, &images.albedo, &images.emission,
          &images.depth, &images.labels})
        if ((*image)()) out.push_back((*image)());
    return out;
}

std::vector<cl_event> raw(const WaitList& events) {
    std::vector<cl_event> out;
    for (const cl::Event& event : events) out.push_back(event());
    return out;
}

void need_success(cl_int error, const char* what) {
    if (error != CL_SUCCESS)
        throw DeviceError(std::string("gl.import: textures cannot be ") + what + " (OpenCL error " +
                          std::to_string(error) + ")");
}

}  // namespace

std::vector<cl::ImageFormat> readable_formats(const cl::Context& context) {
    std::vector<cl::ImageFormat> out;
    context.getSupportedImageFormats(CL_MEM_READ_ONLY, CL_MEM_OBJECT_IMAGE2D, &out);
    return out;
}

bool share(const Sharing& sharing, const cl::Context& context,
           const std::vector<cl::ImageFormat>& formats, Channels& channels, ImportImages& images,
           std::string& why) {
    for (const Channel* channel : channels.given()) {
        const bool readable =
            std::any_of(formats.begin(), formats.end(), [&](const cl::ImageFormat& format) {
                return format.image_channel_order == channel->format->order &&
                       format.image_channel_data_type == channel->format->channel;
            });
        if (readable) continue;
        why = std::string(channel->name) + " is " + channel->format->name +
              ", which OpenCL has no image format for here";
        return false;
    }
    ImportImages made;
    const auto create = [&](const Channel& channel, cl::Image2D& image) {
        if (!channel.texture || !why.empty()) return;
        cl_int error = CL_SUCCESS;
        const cl_mem object =
            sharing.create(context(), CL_MEM_READ_ONLY, GL_TEXTURE_2D, 0, channel.texture, &error);
        if (error == CL_SUCCESS && object)
            image = cl::Image2D(object);
        else
            why = std::string(channel.name) + " cannot be shared (OpenCL error " +
                  std::to_string(error) + ")";
    };
    create(channels.position, made.position);
    create(channels.normal, made.normal);
    create(channels.geometric, made.geometric);
    create(channels.albedo, made.albedo);
    create(channels.emission, made.emission);
    create(channels.depth, made.depth);
    create(channels.ids, made.labels);
    if (!why.empty()) return false;
    images = made;
    return true;
}

cl::Event while_acquired(const Sharing& sharing, const cl::CommandQueue& queue,
                         const ImportImages& images, const WaitList& wait,
                         const std::function<cl::Event(const WaitList&)>& kernel) {
    // Without cl_khr_gl_event nobody but us sees to it that OpenGL has finished drawing.
    if (sharing.implicit)
        glFlush();
    else
        glFinish();
    const std::vector<cl_mem> objects = objects_of(images);
    const auto count = static_cast<cl_uint>(objects.size());
    const std::vector<cl_event> before = raw(wait);
    cl_event acquired = nullptr;
    need_success(
        sharing.acquire(queue(), count, objects.data(), static_cast<cl_uint>(before.size()),
                        before.empty() ? nullptr : before.data(), &acquired),
        "acquired");
    const WaitList ready = {cl::Event(acquired)};
    const auto release = [&](const cl::Event& after) {
        const cl_event last = after();
        cl_event released = nullptr;
        need_success(sharing.release(queue(), count, objects.data(), 1, &last, &released),
                     "released");
        return cl::Event(released);
    };
    cl::Event done;
    try {
        done = kernel(ready);
    } catch (const std::exception&) {
        release(ready.front());
        throw;
    }
    return release(done);
}

}  // namespace clgi::gl
