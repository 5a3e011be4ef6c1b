// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/visible_sets.hpp>
#include <clgi/passes/masks.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/opencl/check.hpp"
#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"

namespace clgi {
namespace {

constexpr std::size_t table_faces = 3;  // PLANE_FACES of kernels/transfer/half_plane.clh

MaskOptions checked(const MaskOptions& options) {
    if (options.size != 8 && options.size != 16 && options.size != 32 && options.size != 64 &&
        options.size != 128)
        throw Error("masks: size is " + std::to_string(options.size) +
                    ", 8, 16, 32, 64 or 128 needed");
    need_range("masks", "table_size", options.table_size, 8, 512);
    if (options.block != 1 && options.block != 2 && options.block != 4 && options.block != 8)
        throw Error("masks: block is " + std::to_string(options.block) + ", 1, 2, 4 or 8 needed");
    need_range("masks", "bands", options.bands, 1, sh::most_bands);
    return options;
}

void need_receivers(const PassKernel& pass, const ReceiverBuffers& r) {
    need_countable(pass.name, "receivers", RECEIVER_PLANES, r.stride);
    need_stride(pass, "receiver stride", r.stride, r.count);
    need(pass, "receivers", r.planes, RECEIVER_PLANES * word * r.stride);
}

void need_blockers(const PassKernel& pass, const BlockerBuffers& b) {
    if (b.stride != blocker_stride(b.triangle_count))
        throw Error(pass.name + ": blocker stride is " + std::to_string(b.stride) + ", " +
                    std::to_string(blocker_stride(b.triangle_count)) + " needed");
    need_countable(pass.name, "corners", BLOCKER_PLANES, b.stride);
    need(pass, "corners", b.corners, BLOCKER_PLANES * word * b.stride);
    need(pass, "boxes", b.boxes, b.stride / BLOCKER_CLUSTER * sizeof(BlockerBox));
}

bool has_singles(const BlockerBuffers& b) { return b.near_lists() || b.near(); }

// BLOCKER_ARGUMENTS of kernels/transfer/lists.clh, of the kernel with singles where there are some.
struct Listed {
    const BlockerBuffers& blockers;
};
void set_argument(cl::Kernel& kernel, cl_uint& index, const Listed& from) {
    const BlockerBuffers& b = from.blockers;
    for (const cl::Buffer* buffer : {&b.lists, &b.ranges, &b.boxes, &b.corners})
        kernel.setArg(index++, *buffer);
    if (!has_singles(b)) return;
    kernel.setArg(index++, b.near_lists);
    kernel.setArg(index++, b.near);
}

void need_lists(const PassKernel& pass, const ReceiverBuffers& r, const BlockerBuffers& b) {
    if (b.receivers_per_list == 0)
        throw Error(pass.name + ": receivers_per_list is 0, at least 1 needed");
    const std::size_t lists =
        (std::size_t{r.count} + b.receivers_per_list - 1) / b.receivers_per_list;
    need(pass, "lists", b.lists, (lists + 1) * word);
    need(pass, "ranges", b.ranges, 2 * word);
    if (!has_singles(b)) return;
    need(pass, "near_lists", b.near_lists, (std::size_t{r.count} + 1) * word);
    need(pass, "near", b.near, word);
}

}  // namespace

std::size_t mask_table_bytes(const MaskOptions& options) {
    const auto size = static_cast<std::size_t>(checked(options).size);
    if (options.planes == EdgePlanes::exact) return size * MASK_COLUMNS(size) * word;
    const auto texels = static_cast<std::size_t>(options.table_size);
    return table_faces * texels * texels * MASK_WORDS(size) * word;
}

std::vector<float> pixel_heights(int size) {
    const int columns = MASK_COLUMNS(size);
    std::vector<float> out(static_cast<std::size_t>(size) * columns);
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const double x = (2 * column + 1.0) / size - 1.0, y = (2 * row + 1.0) / size - 1.0;
            const double square = 1.0 - x * x - y * y;
            if (square > 0.0) out[row * columns + column] = static_cast<float>(std::sqrt(square));
        }
    return out;
}

MaskPasses::MaskPasses(const Programs& programs, const MaskOptions& masks,
                       const BuildOptions& options)
    : masks_(checked(masks)) {
    const std::string size = "-DCLGI_MASK=" + std::to_string(masks_.size);
    const auto few = [&](const char* pass, const BuildOptions& how, const std::string& defines) {
        return in_small_groups(programs.kernel("transfer", pass, how, defines), programs.device(),
                               options);
    };
    receivers_ = programs.kernel("transfer", "receivers", scalar(options));
    blockers_ = few("blockers", scalar(options), "");
    planes_ = programs.kernel("transfer", "planes", full(options), size);
    const std::string drawn = masks_.planes == EdgePlanes::table ? size + " -DCLGI_TABLE" : size;
    mask_ = few("mask", full(options), drawn);
    mask_near_ = few("mask", full(options), drawn + " -DCLGI_NEAR");
    mask_near_.name = "transfer.mask_near";
    visible_ = few("visible", full(options), size);
    visible_near_ = few("visible", full(options), size + " -DCLGI_NEAR");
    visible_near_.name = "transfer.visible_near";
    exitance_ = programs.kernel("transfer", "exitance", scalar(options));
    bounce_ = few("bounce", full(options), size);
    bounce_near_ = few("bounce", full(options), size + " -DCLGI_NEAR");
    bounce_near_.name = "transfer.bounce_near";
    const std::string bands = " -DCLGI_SH_BANDS=" + std::to_string(masks_.bands);
    const std::string cells = size + " -DCLGI_BLOCK=" + std::to_string(masks_.block) + bands;
    integrate_ = few("integrate", full(options), cells);
    integrate_gloss_ = few("integrate", full(options), cells + " -DCLGI_GLOSS");
    integrate_gloss_.name = "transfer.integrate_gloss";
    integrate_open_gloss_ = few("integrate", full(options), cells + " -DCLGI_GLOSS -DCLGI_OPEN");
    integrate_open_gloss_.name = "transfer.integrate_open_gloss";
    shade_ = few("shade", full(options), bands.substr(1));
}

void MaskPasses::build(std::initializer_list<const char*> passes) const {
    build_named(
        {receivers_, blockers_, planes_, mask_, mask_near_, visible_, visible_near_, exitance_,
         bounce_, bounce_near_, integrate_, integrate_gloss_, integrate_open_gloss_, shade_},
        passes);
}

cl::Event MaskPasses::receivers(const cl::CommandQueue& queue, const cl::Buffer& positions,
                                const cl::Buffer& normals, const ReceiverBuffers& r,
                                const cl::Buffer& status, const WaitList& wait) const {
    need_receivers(receivers_, r);
    need(receivers_, "positions", positions, std::size_t{r.count} * sizeof(glm::vec4));
    need(receivers_, "normals", normals, std::size_t{r.count} * sizeof(glm::vec4));
    need(receivers_, "status", status, MASK_STATUS_WORDS * word);
    return launch(receivers_, queue, r.count, wait, ReceiverParams{r.count, r.stride, 0, 0},
                  positions, normals, r.planes, status);
}

cl::Event MaskPasses::blockers(const cl::CommandQueue& queue, const cl::Buffer& triangles,
                               const cl::Buffer& positions, const BlockerBuffers& b,
                               const cl::Buffer& status, const WaitList& wait) const {
    need_blockers(blockers_, b);
    need(blockers_, "triangles", triangles, std::size_t{b.triangle_count} * sizeof(glm::uvec4));
    need(blockers_, "positions", positions, b.triangle_count > 0 ? sizeof(glm::vec4) : 0);
    need(blockers_, "status", status, MASK_STATUS_WORDS * word);
    return launch(blockers_, queue, b.stride / BLOCKER_CLUSTER, wait,
                  BlockerParams{b.triangle_count, b.stride, 0, 0}, triangles, positions, b.corners,
                  b.boxes, status);
}

cl::Event MaskPasses::planes(const cl::CommandQueue& queue, const cl::Buffer& heights,
                             const cl::Buffer& table, const WaitList& wait) const {
    MaskOptions exact = masks_, rounded = masks_;
    exact.planes = EdgePlanes::exact;
    rounded.planes = EdgePlanes::table;
    need(planes_, "heights", heights, mask_table_bytes(exact));
    need(planes_, "table", table, mask_table_bytes(rounded));
    const auto texels = static_cast<std::size_t>(masks_.table_size);
    return launch(planes_, queue, table_faces * texels * texels, wait,
                  static_cast<cl_uint>(masks_.table_size), heights, table);
}

cl::Event MaskPasses::mask(const cl::CommandQueue& queue, const ReceiverBuffers& r,
                           const BlockerBuffers& b, const cl::Buffer& drawn,
                           const WaitList& wait) const {
    const PassKernel& pass = has_singles(b) ? mask_near_ : mask_;
    need_countable(pass.name, "masks", MASK_WORDS(static_cast<std::size_t>(masks_.size)), r.stride);
    need_receivers(pass, r);
    need_blockers(pass, b);
    need_lists(pass, r, b);
    need(pass, "drawn", drawn, mask_table_bytes(masks_));
    need(pass, "masks", r.masks,
         std::size_t{MASK_WORDS(static_cast<std::size_t>(masks_.size))} * r.stride * word);
    const auto table_size = static_cast<std::uint32_t>(masks_.table_size);
    const MaskParams params{r.count, r.stride, b.stride, b.receivers_per_list, table_size, 0, 0, 0};
    return launch(pass, queue, r.count, wait, params, r.planes, Listed{b}, drawn, r.masks);
}

cl::Event MaskPasses::visible(const cl::CommandQueue& queue, const ReceiverBuffers& r,
                              const BlockerBuffers& b, const cl::Buffer& heights,
                              const cl::Buffer& seen, const WaitList& wait) const {
    const PassKernel& pass = has_singles(b) ? visible_near_ : visible_;
    const std::size_t columns = packets(pass, MASK_COLUMNS(masks_.size));
    need_items(pass.name, r.count * columns);
    need_receivers(pass, r);
    need_blockers(pass, b);
    need_lists(pass, r, b);
    need_countable(pass.name, "seen", visible_words(b.triangle_count), r.stride);
    MaskOptions exact = masks_;
    exact.planes = EdgePlanes::exact;
    need(pass, "heights", heights, mask_table_bytes(exact));
    need(pass, "seen", seen, visible_words(b.triangle_count) * r.stride * word);
    const MaskParams params{r.count, r.stride, b.stride, b.receivers_per_list, 0, 0, 0, 0};
    return launch(pass, queue, r.count * columns, wait, params, r.planes, Listed{b}, heights, seen);
}

cl::Event MaskPasses::exitance(const cl::CommandQueue& queue, const BounceParams& params,
                               const cl::Buffer& triangles, const cl::Buffer& other_side,
                               const cl::Buffer& reflectance, const cl::Buffer& irradiance,
                               const cl::Buffer& out, const WaitList& wait) const {
    need_countable(exitance_.name, "irradiance", 3, params.receiver_stride);
    need(exitance_, "triangles", triangles, params.triangle_count * sizeof(glm::uvec4));
    need(exitance_, "other_side", other_side, params.triangle_count > 0 ? word : 0);
    need(exitance_, "reflectance", reflectance, 3 * word * params.receiver_stride);
    need(exitance_, "irradiance", irradiance, 3 * word * params.receiver_stride);
    need(exitance_, "exitance", out, 2 * std::size_t{params.triangle_count} * sizeof(glm::vec4));
    return launch(exitance_, queue, params.triangle_count, wait, params, triangles, other_side,
                  reflectance, irradiance, out);
}

cl::Event MaskPasses::bounce(const cl::CommandQueue& queue, const ReceiverBuffers& r,
                             const BlockerBuffers& b, const cl::Buffer& heights,
                             const cl::Buffer& exitance, const cl::Buffer& irradiance,
                             const cl::Buffer& non_finite, const WaitList& wait) const {
    const PassKernel& pass = has_singles(b) ? bounce_near_ : bounce_;
    need_countable(pass.name, "irradiance", 3, r.stride);
    need_receivers(pass, r);
    need_blockers(pass, b);
    need_lists(pass, r, b);
    MaskOptions exact = masks_;
    exact.planes = EdgePlanes::exact;
    need(pass, "heights", heights, mask_table_bytes(exact));
    need(pass, "exitance", exitance, 2 * std::size_t{b.triangle_count} * sizeof(glm::vec4));
    need(pass, "irradiance", irradiance, 3 * word * r.stride);
    need(pass, "non_finite", non_finite, word);
    const std::vector<float> z = pixel_heights(masks_.size);
    const auto pixels = std::count_if(z.begin(), z.end(), [](float height) { return height > 0; });
    const MaskParams params{r.count, r.stride, b.stride, b.receivers_per_list, 0, 0, 0, 0};
    const BounceParams share{b.triangle_count, r.stride,
                             glm::pi<float>() / static_cast<float>(pixels), 0};
    return launch(pass, queue, r.count, wait, params, share, r.planes, Listed{b}, heights, exitance,
                  irradiance, non_finite);
}

std::size_t MaskPasses::need_integral(const PassKernel& pass, const ReceiverBuffers& r,
                                      const cl::Buffer& weights, const cl::Buffer& directions,
                                      const cl::Buffer& transfer) const {
    const auto side = static_cast<std::size_t>(std::max(masks_.size / masks_.block, 1));
    const auto terms = static_cast<std::size_t>(sh::terms(masks_.bands));
    need_countable(pass.name, "transfer", terms, r.stride);
    need_receivers(pass, r);
    const std::size_t turns = 2 * static_cast<std::size_t>(masks_.bands) - 1;
    need(pass, "weights", weights, (side * side + 1) * terms * word);
    need(pass, "directions", directions, (turns + side * side) * sizeof(glm::vec4));
    need(pass, "transfer", transfer, terms * r.stride * word);
    return packets(pass, r.count);
}

void MaskPasses::need_masks(const PassKernel& pass, const ReceiverBuffers& r) const {
    const std::size_t words = MASK_WORDS(static_cast<std::size_t>(masks_.size));
    need_countable(pass.name, "masks", words, r.stride);
    need(pass, "masks", r.masks, words * r.stride * word);
}

cl::Event MaskPasses::integrate(const cl::CommandQueue& queue, const ReceiverBuffers& r,
                                const cl::Buffer& weights, const cl::Buffer& directions,
                                const WaitList& wait) const {
    need_masks(integrate_, r);
    const std::size_t items = need_integral(integrate_, r, weights, directions, r.transfer);
    return launch(integrate_, queue, items, wait,
                  IntegrateParams{glm::vec4(0.0f), r.count, r.stride, 0, 0}, r.planes, r.masks,
                  weights, directions, r.transfer);
}

cl::Event MaskPasses::integrate_gloss(const cl::CommandQueue& queue, const ReceiverBuffers& r,
                                      const cl::Buffer& weights, const cl::Buffer& directions,
                                      const cl::Buffer& exponents, const glm::vec4& eye,
                                      const cl::Buffer& lobes, const WaitList& wait) const {
    const PassKernel& pass = r.masks() ? integrate_gloss_ : integrate_open_gloss_;
    const std::size_t items = need_integral(pass, r, weights, directions, lobes);
    need(pass, "exponents", exponents, word * r.stride);
    if (!r.masks())
        return launch(pass, queue, items, wait, IntegrateParams{eye, r.count, r.stride, 0, 0},
                      r.planes, weights, directions, exponents, lobes);
    need_masks(pass, r);
    return launch(integrate_gloss_, queue, items, wait,
                  IntegrateParams{eye, r.count, r.stride, 0, 0}, r.planes, r.masks, weights,
                  directions, exponents, lobes);
}

cl::Event MaskPasses::shade(const cl::CommandQueue& queue, const ReceiverBuffers& r,
                            const cl::Buffer& transfer, const cl::Buffer& light,
                            std::uint32_t flags, const cl::Buffer& irradiance,
                            const cl::Buffer& non_finite, const WaitList& wait) const {
    const auto terms = static_cast<std::size_t>(sh::terms(masks_.bands));
    need_stride(shade_, "receiver stride", r.stride, r.count);
    need_countable(shade_.name, "transfer", terms, r.stride);
    need(shade_, "transfer", transfer, terms * r.stride * word);
    need(shade_, "light", light, terms * sizeof(glm::vec4));
    need(shade_, "irradiance", irradiance, 3 * word * r.stride);
    need(shade_, "non_finite", non_finite, word);
    return launch(shade_, queue, packets(shade_, r.count), wait,
                  ShadeParams{r.count, r.stride, flags, 0}, transfer, light, irradiance,
                  non_finite);
}

}  // namespace clgi
