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

bool SharedImages::share(const Sharing& sharing, const cl::Context& context,
                         const std::vector<cl::ImageFormat>& formats, Channels& channels,
                         const View& view, ImportImages& images, std::string& why) {
    for (const Channel* channel : channels.given()) {
        const bool readable =
            std::any_of(formats.begin(), formats.end(), [&](const cl::ImageFormat& format) {
                return format.image_channel_order == channel->format->order &&
                       format.image_channel_data_type == channel->format->channel;
            });
        if (readable) continue;
        clear();
        why = std::string(channel->name) + " is " + channel->format->name +
              ", which OpenCL has no image format for here";
        return false;
    }
    const Channel* all[] = {&channels.position, &channels.normal,   &channels.geometric,
                            &channels.albedo,   &channels.emission, &channels.depth,
                            &channels.ids};
    for (std::size_t i = 0; i < kept_.size(); ++i) {
        const Channel& channel = *all[i];
        Kept& kept = kept_[i];
        if (kept.texture == channel.texture && kept.format == channel.format &&
            kept.width == view.width && kept.height == view.height)
            continue;
        kept = Kept();  // before a new one is made: its texture may be gone
        if (!channel.texture) continue;
        cl_int error = CL_SUCCESS;
        const cl_mem object =
            sharing.create(context(), CL_MEM_READ_ONLY, GL_TEXTURE_2D, 0, channel.texture, &error);
        if (error != CL_SUCCESS || !object) {
            clear();
            why = std::string(channel.name) + " cannot be shared (OpenCL error " +
                  std::to_string(error) + ")";
            return false;
        }
        kept = {channel.texture, channel.format, view.width, view.height, cl::Image2D(object)};
    }
    images = {kept_[0].image, kept_[1].image, kept_[2].image, kept_[3].image,
              kept_[4].image, kept_[5].image, kept_[6].image};
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
