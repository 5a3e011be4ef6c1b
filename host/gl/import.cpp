// SPDX-License-Identifier: MIT
#include <clgi/gl/gbuffer.hpp>

#include <clgi/error.hpp>

#include "gl/current.hpp"
#include "gl/readback.hpp"
#include "gl/shared_images.hpp"

namespace clgi::gl {
namespace {

// What OpenCL throws becomes a DeviceError that says what was being done.
template <typename Work>
auto on_device(const char* what, Work&& work) {
    try {
        return work();
    } catch (const cl::Error& error) {
        throw DeviceError("gl.import: " + std::string(what) + " (OpenCL error " +
                          std::to_string(error.err()) + " in " + error.what() + ")");
    }
}

}  // namespace

class GBufferImport::State {
public:
    State(const cl::Context& owner, const cl::Device& device, const Sharing& way,
          const BuildOptions& options)
        : context(owner),
          sharing(way),
          passes(owner, device, options),
          readback(owner),
          zero_copy(way.zero_copy),
          path(way.reason) {
        if (way.zero_copy && !(way.create && way.acquire && way.release))
            throw Error("gl.import: zero copy is asked for, its three entry points needed");
        on_device("no room for a counter", [&] {
            if (sharing.zero_copy) formats = readable_formats(context);
            std::uint32_t zero = 0;
            non_finite =
                cl::Buffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, sizeof zero, &zero);
        });
    }

    cl::Event copied(const cl::CommandQueue& queue, const View& view, ImportParams params,
                     Channels& channels, const GBuffer& out, const WaitList& wait) {
        const auto texel = [](const Channel& channel) {
            return channel.texture ? channel.format->texel : std::uint32_t{TEXEL_RGBA32F};
        };
        params.normal_format = texel(channels.normal);
        params.geometric_format = texel(channels.geometric);
        params.albedo_format = texel(channels.albedo);
        params.emission_format = texel(channels.emission);
        WaitList ready = wait;
        const ImportBuffers texels = readback.read(queue, channels, view, ready);
        const cl::Event event = passes.buffers(queue, view, params, texels, out, non_finite, ready);
        readback.set_reader(event);
        return event;
    }

    cl::Context context;
    Sharing sharing;
    std::vector<cl::ImageFormat> formats;
    ImportPasses passes;
    Readback readback;
    SharedImages shared;
    cl::Buffer non_finite;
    bool zero_copy;
    std::string path;
    cl::CommandQueue last_queue;  // of the last conversion
    WaitList last;                // its end
};

GBufferImport::GBufferImport(const cl::Context& context, const cl::Device& device,
                             const BuildOptions& options)
    : GBufferImport(context, device, find_sharing(context, device), options) {}

GBufferImport::GBufferImport(const cl::Context& context, const cl::Device& device,
                             const Sharing& sharing, const BuildOptions& options) {
    need_context("gl.import");
    state_ = std::make_unique<State>(context, device, sharing, options);
}

GBufferImport::~GBufferImport() = default;

cl::Event GBufferImport::convert(const cl::CommandQueue& queue, const View& view,
                                 const DeviceScene& scene, const GBufferTextures& textures,
                                 const GBuffer& out, const WaitList& wait) {
    need_context("gl.import");
    need_no_errors("gl.import");
    Channels channels = inspect(textures, view);
    ImportParams params = import_params(scene, out.stride, textures.origin);
    params.flags = channels.flags(textures.top_first);

    // Whether sharing works for these very textures shows before anything is enqueued.
    State& state = *state_;
    ImportImages images;
    std::string why;
    state.zero_copy =
        state.sharing.zero_copy && state.shared.share(state.sharing, state.context, state.formats,
                                                      channels, view, images, why);
    state.path = why.empty() ? state.sharing.reason : "copied: " + why;
    const cl::Event event = on_device("the textures cannot be read", [&] {
        if (!state.zero_copy) return state.copied(queue, view, params, channels, out, wait);
        try {
            return while_acquired(state.sharing, queue, images, wait,
                                  [&](const WaitList& acquired) {
                                      return state.passes.images(queue, view, params, images, out,
                                                                 state.non_finite, acquired);
                                  });
        } catch (const std::exception&) {
            state.shared.clear();  // the next conversion tries with images made anew
            throw;
        }
    });
    state.last_queue = queue;
    state.last.assign(1, event);
    return event;
}

void GBufferImport::forget_textures() { state_->shared.clear(); }

bool GBufferImport::zero_copy() const { return state_->zero_copy; }

const std::string& GBufferImport::path() const { return state_->path; }

std::uint32_t GBufferImport::non_finite() const {
    std::uint32_t count = 0;
    if (state_->last.empty()) return count;
    on_device("the count cannot be read", [&] {
        state_->last_queue.enqueueReadBuffer(state_->non_finite, CL_TRUE, 0, sizeof count, &count,
                                             &state_->last);
    });
    return count;
}

}  // namespace clgi::gl
