// SPDX-License-Identifier: MIT
#include <clgi/shared/masks.h>
#include <clgi/advanced/planes.hpp>
#include <clgi/advanced/sh.hpp>
#include <clgi/passes/transfer.hpp>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"
#include "methods/transfer/sh_check.hpp"

namespace clgi {

static_assert(sh::most_bands == SH_MOST_BANDS && sh::default_bands == SH_DEFAULT_BANDS);

namespace {

std::size_t blocks_of(const ProjectParams& params) {
    return (std::size_t{params.height} + PROJECT_ROWS - 1) / PROJECT_ROWS;
}

std::size_t wave_count(int bands) { return SH_WAVES(static_cast<std::size_t>(bands)); }
std::size_t terms_of(int bands) { return static_cast<std::size_t>(sh::terms(bands)); }

void need_picture(const PassKernel& pass, const ProjectParams& params) {
    const std::size_t floats = 3 * std::size_t{params.width};
    if (params.width == 0 || params.height == 0 || params.width > 65536 || params.height > 65536)
        throw Error(pass.name + ": a picture of " + std::to_string(params.width) + "x" +
                    std::to_string(params.height) + " texels, 1x1 to 65536x65536 needed");
    if (params.stride < floats || params.stride % PROJECT_LEAF != 0)
        throw Error(pass.name + ": stride is " + std::to_string(params.stride) +
                    ", a multiple of " + std::to_string(int{PROJECT_LEAF}) + " of at least " +
                    std::to_string(floats) + " needed");
}

void need_sums(const PassKernel& pass, const ProjectParams& params, int bands,
               const ProjectionBuffers& b) {
    need(pass, "sums", b.sums, word * blocks_of(params) * wave_count(bands) * params.stride);
}

void need_leaves(const PassKernel& pass, const ProjectParams& params, int bands,
                 const ProjectionBuffers& b) {
    need(pass, "leaves", b.leaves,
         params.stride / PROJECT_LEAF * wave_count(bands) * static_cast<std::size_t>(bands) *
             sizeof(float4));
}

void need_rows(const PassKernel& pass, const ProjectParams& params, int bands,
               const ProjectionBuffers& b) {
    need_picture(pass, params);
    need(pass, "texels", b.texels, 3 * word * params.width * params.height);
    need(pass, "row_weights", b.row_weights, word * wave_count(bands) * params.height);
    need_sums(pass, params, bands, b);
    need(pass, "non_finite", b.non_finite, word);
}

void need_columns(const PassKernel& pass, const ProjectParams& params, int bands,
                  const ProjectionBuffers& b) {
    need_picture(pass, params);
    need_sums(pass, params, bands, b);
    need(pass, "column_weights", b.column_weights, word * wave_count(bands) * params.stride);
    need_leaves(pass, params, bands, b);
}

void need_environment(const PassKernel& pass, const ProjectParams& params, int bands,
                      const ProjectionBuffers& b) {
    need_picture(pass, params);
    need_leaves(pass, params, bands, b);
    need(pass, "waves", b.waves, word * static_cast<std::size_t>(SH_MOMENT(bands, 0) * bands));
    need(pass, "rotation", b.rotation, word * static_cast<std::size_t>(sh::rotation_block(bands)));
    if (params.light_count > 0)
        need(pass, "lights", b.lights, params.light_count * sizeof(DirectionalLight));
    need(pass, "light", b.light, terms_of(bands) * sizeof(float4));
}

}  // namespace

OpenParams open_params(int bands, sh::Window window, std::uint32_t normal, std::uint32_t count,
                       std::uint32_t stride) {
    OpenParams out{};
    const std::vector<double> cosine = sh::cosine_kernel(bands);
    const std::vector<double> factor = sh::window(window, bands);
    for (std::size_t l = 0; l < cosine.size(); ++l)
        out.cosine[l] = static_cast<float>(cosine[l] * factor[l]);
    out.receiver_count = count;
    out.stride = stride;
    out.normal = normal;
    out.flags = SHADE_CLAMP;
    return out;
}

TransferPasses::TransferPasses(const Programs& programs, const BuildOptions& options, int bands)
    : bands_(bands) {
    sh::need_bands(bands);
    const std::string defines = "-DCLGI_SH_BANDS=" + std::to_string(bands);
    const auto kernel = [&](const char* pass, const BuildOptions& how) {
        return in_small_groups(programs.kernel("transfer", pass, how, defines), programs.device(),
                               options);
    };
    project_rows_ = kernel("project_rows", full(options));
    const bool groups = in_groups(programs.device(), options);
    column_parts_ = groups ? (static_cast<std::size_t>(bands) + PROJECT_FEW - 1) / PROJECT_FEW : 1;
    project_columns_ = groups ? programs.kernel("transfer", "project_columns", scalar(options),
                                                defines + " -DCLGI_GROUPS")
                              : kernel("project_columns", scalar(options));
    project_environment_ = kernel("project_environment", scalar(options));
    open_ = kernel("open", options);
}

void TransferPasses::build(std::initializer_list<const char*> passes) const {
    build_named({project_rows_, project_columns_, project_environment_, open_}, passes);
}

cl::Event TransferPasses::project_rows(const cl::CommandQueue& queue, const ProjectParams& params,
                                       const ProjectionBuffers& b, const WaitList& wait) const {
    need_rows(project_rows_, params, bands_, b);
    return launch_rows(project_rows_, queue, packets(project_rows_, params.stride),
                       blocks_of(params), wait, params, b.texels, b.row_weights, b.sums,
                       b.non_finite);
}

cl::Event TransferPasses::project_columns(const cl::CommandQueue& queue,
                                          const ProjectParams& params, const ProjectionBuffers& b,
                                          const WaitList& wait) const {
    need_columns(project_columns_, params, bands_, b);
    return launch_rows(project_columns_, queue, params.stride / PROJECT_LEAF,
                       wave_count(bands_) * column_parts_, wait, params, b.sums, b.column_weights,
                       b.leaves);
}

cl::Event TransferPasses::project_environment(const cl::CommandQueue& queue,
                                              const ProjectParams& params,
                                              const ProjectionBuffers& b,
                                              const WaitList& wait) const {
    need_environment(project_environment_, params, bands_, b);
    return launch(project_environment_, queue, terms_of(bands_), wait, params, b.leaves, b.waves,
                  b.rotation, b.lights, b.light);
}

cl::Event TransferPasses::project(const cl::CommandQueue& queue, const ProjectParams& params,
                                  const ProjectionBuffers& b, const WaitList& wait) const {
    need_columns(project_columns_, params, bands_, b);
    need_environment(project_environment_, params, bands_, b);
    const cl::Event rows = project_rows(queue, params, b, wait);
    const cl::Event columns = project_columns(queue, params, b, {rows});
    return project_environment(queue, params, b, {columns});
}

cl::Event TransferPasses::open(const cl::CommandQueue& queue, const OpenParams& params,
                               const cl::Buffer& planes, const cl::Buffer& light,
                               const cl::Buffer& irradiance, const cl::Buffer& non_finite,
                               const WaitList& wait) const {
    need_stride(open_, "stride", params.stride, params.receiver_count);
    need(open_, "planes", planes,
         gbuffer_bytes(open_.storage, params.stride, params.normal + std::size_t{3}));
    need(open_, "light", light, terms_of(bands_) * sizeof(float4));
    need(open_, "irradiance", irradiance, irradiance_bytes(open_.storage, params.stride));
    need(open_, "non_finite", non_finite, word);
    return launch(open_, queue, packets(open_, params.receiver_count), wait, params, planes, light,
                  irradiance, non_finite);
}

}  // namespace clgi
