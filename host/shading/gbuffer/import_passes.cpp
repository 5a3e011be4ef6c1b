// SPDX-License-Identifier: MIT
#include <clgi/passes/import.hpp>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"

namespace clgi {
namespace {

std::size_t pixels_of(const View& view) {
    return static_cast<std::size_t>(view.width) * view.height;
}

const char* name_of(Storage storage) { return storage == Storage::half ? "half" : "full"; }

void need_target(const PassKernel& pass, const View& view, const ImportParams& params,
                 const GBuffer& out, const cl::Buffer& non_finite) {
    if (!(params.flags & (IMPORT_POSITION | IMPORT_DEPTH)))
        throw Error(pass.name + ": neither positions nor depth are given, one of them needed");
    if ((params.flags & IMPORT_TRIANGLE) && !(params.flags & IMPORT_MATERIAL))
        throw Error(pass.name + ": IMPORT_TRIANGLE is given, IMPORT_MATERIAL needed beside it");
    need_stride(pass, "stride", params.stride, pixels_of(view));
    if (out.stride != params.stride)
        throw Error(pass.name + ": the G-buffer's stride is " + std::to_string(out.stride) + ", " +
                    std::to_string(params.stride) + " needed");
    if (out.storage != pass.storage)
        throw Error(pass.name + ": the G-buffer's storage is " + name_of(out.storage) + ", " +
                    name_of(pass.storage) + " needed, that of the pass's BuildOptions");
    need(pass, "planes", out.planes, gbuffer_bytes(pass.storage, params.stride));
    need(pass, "ids", out.ids, sizeof(std::int32_t) * GBUFFER_ID_PLANES * params.stride);
    need(pass, "non_finite", non_finite, sizeof(std::uint32_t));
}

void need_format(const PassKernel& pass, const char* name, std::uint32_t format) {
    if (format > TEXEL_RGBA8)
        throw Error(pass.name + ": " + name + " is " + std::to_string(format) +
                    ", 0 (RGBA32F), 1 (RGBA16F) or 2 (RGBA8) needed");
}

void need_image(const PassKernel& pass, const char* name, const cl::Image2D& image,
                const View& view) {
    const std::size_t width = image() ? image.getImageInfo<CL_IMAGE_WIDTH>() : 0;
    const std::size_t height = image() ? image.getImageInfo<CL_IMAGE_HEIGHT>() : 0;
    if (width != view.width || height != view.height)
        throw Error(pass.name + ": " + name + " is " + std::to_string(width) + "x" +
                    std::to_string(height) + ", " + std::to_string(view.width) + "x" +
                    std::to_string(view.height) + " needed");
}

}  // namespace

std::size_t texel_bytes(std::uint32_t format) {
    return format == TEXEL_RGBA32F ? 16 : format == TEXEL_RGBA16F ? 8 : 4;
}

ImportParams import_params(const DeviceScene& scene, std::uint32_t stride,
                           const glm::dvec3& origin) {
    const SceneFrame& frame = scene.frame();
    ImportParams out{};
    out.offset = glm::vec4(frame.to_local(origin), 0.0f);
    out.scale = static_cast<float>(frame.scale);
    out.light = static_cast<float>(1.0 / frame.exposure);
    out.stride = stride;
    out.material_count = static_cast<std::uint32_t>(scene.materials().getInfo<CL_MEM_SIZE>() /
                                                    sizeof(MaterialRecord));
    out.triangle_count = scene.info().triangle_count;
    return out;
}

ImportPasses::ImportPasses(const Programs& programs, const BuildOptions& options)
    : buffers_(programs.kernel("gbuffer", "import_buffers", options)) {
    if (programs.device().getInfo<CL_DEVICE_IMAGE_SUPPORT>())
        images_ = programs.kernel("gbuffer", "import_images", options);
}

cl::Event ImportPasses::buffers(const cl::CommandQueue& queue, const View& view,
                                const ImportParams& params, const ImportBuffers& texels,
                                const GBuffer& out, const cl::Buffer& non_finite,
                                const WaitList& wait) const {
    need_target(buffers_, view, params, out, non_finite);
    need_format(buffers_, "normal_format", params.normal_format);
    need_format(buffers_, "geometric_format", params.geometric_format);
    need_format(buffers_, "albedo_format", params.albedo_format);
    need_format(buffers_, "emission_format", params.emission_format);
    const std::size_t pixels = pixels_of(view);
    need(buffers_, "normal", texels.normal, pixels * texel_bytes(params.normal_format));
    need(buffers_, "albedo", texels.albedo, pixels * texel_bytes(params.albedo_format));
    // A buffer for every argument: normals stand in for what is left out.
    const auto optional = [&](const char* name, const cl::Buffer& buffer, std::uint32_t flag,
                              std::size_t bytes) -> const cl::Buffer& {
        if (!(params.flags & flag)) return texels.normal;
        need(buffers_, name, buffer, pixels * bytes);
        return buffer;
    };
    return launch(
        buffers_, queue, packets(buffers_, pixels), wait, view, params,
        optional("position", texels.position, IMPORT_POSITION, 4 * sizeof(float)), texels.normal,
        optional("geometric", texels.geometric, IMPORT_GEOMETRIC,
                 texel_bytes(params.geometric_format)),
        texels.albedo,
        optional("emission", texels.emission, IMPORT_EMISSION, texel_bytes(params.emission_format)),
        optional("depth", texels.depth, IMPORT_DEPTH, sizeof(float)),
        optional("labels", texels.labels, IMPORT_MATERIAL, params.flags & IMPORT_TRIANGLE ? 8 : 4),
        out.planes, out.ids, non_finite);
}

cl::Event ImportPasses::images(const cl::CommandQueue& queue, const View& view,
                               const ImportParams& params, const ImportImages& texels,
                               const GBuffer& out, const cl::Buffer& non_finite,
                               const WaitList& wait) const {
    if (!images_.slot) throw Error("gbuffer.import_images: the device has no images");
    need_target(images_, view, params, out, non_finite);
    need_image(images_, "normal", texels.normal, view);
    need_image(images_, "albedo", texels.albedo, view);
    const auto optional = [&](const char* name, const cl::Image2D& image,
                              std::uint32_t flag) -> const cl::Image2D& {
        if (!(params.flags & flag)) return texels.normal;
        need_image(images_, name, image, view);
        return image;
    };
    return launch(images_, queue, packets(images_, pixels_of(view)), wait, view, params,
                  optional("position", texels.position, IMPORT_POSITION), texels.normal,
                  optional("geometric", texels.geometric, IMPORT_GEOMETRIC), texels.albedo,
                  optional("emission", texels.emission, IMPORT_EMISSION),
                  optional("depth", texels.depth, IMPORT_DEPTH),
                  optional("labels", texels.labels, IMPORT_MATERIAL), out.planes, out.ids,
                  non_finite);
}

}  // namespace clgi
