// SPDX-License-Identifier: MIT
#include "lab/transfer_vectors.hpp"

#include <clgi/shared/receivers.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace clgi::lab {
namespace {

template <typename T>
std::vector<T> read_back(const cl::CommandQueue& queue, const cl::Buffer& buffer,
                         std::size_t count) {
    std::vector<T> out(count);
    if (count > 0) queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), out.data());
    return out;
}

// "T.2.-1"
std::string channel_name(int term) {
    const int l = sh::degree(term);
    return fmt::format("T.{}.{}", l, term - sh::index(l, 0));
}

void add_channels(io::Image& out, const std::string& prefix, const std::vector<Plane>& planes) {
    const auto pixels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        out.channels.push_back({prefix + channel_name(static_cast<int>(i)), planes[i]});
        out.channels.back().values.resize(pixels, 0.0f);
    }
}

void add_attributes(std::vector<io::VertexAttribute>& out, const std::string& name,
                    const std::vector<Plane>& planes, bool double_sided) {
    for (std::size_t first = 0; first < planes.size(); first += 4) {
        io::VertexAttribute one;
        one.name = name + std::to_string(first / 4);
        one.double_sided = double_sided;
        one.values.assign(planes[first].size(), glm::vec4(0.0f));
        for (std::size_t i = first; i < std::min(first + 4, planes.size()); ++i)
            for (std::size_t v = 0; v < one.values.size(); ++v)
                one.values[v][static_cast<int>(i - first)] = planes[i][v];
        out.push_back(std::move(one));
    }
}

}  // namespace

TransferVectors transfer_vectors(const cl::CommandQueue& queue, const DynamicTransferSolver& solver,
                                 const DeviceScene& scene) {
    solver.status();  // waits
    const ReceiverBuffers& receivers = solver.receivers();
    const std::size_t stride = receivers.stride;
    TransferVectors out;
    out.bands = solver.options().masks.bands;
    out.vertices = scene.file_vertex_count();
    const auto terms = static_cast<std::size_t>(sh::terms(out.bands));
    const auto found = read_back<float>(queue, receivers.transfer, terms * stride);
    const std::vector<std::uint32_t>& order = scene.vertex_order();
    const auto other = read_back<std::uint32_t>(queue, solver.other_side(), order.size());
    out.front.assign(terms, Plane(out.vertices, 0.0f));
    if (receivers.count > order.size()) out.back = out.front;
    for (std::size_t i = 0; i < terms; ++i) {
        const auto value = [&](std::size_t receiver) {
            const float number = found[i * stride + receiver];
            if (std::isfinite(number)) return number;
            ++out.non_finite;
            return 0.0f;
        };
        for (std::size_t v = 0; v < order.size(); ++v) {
            out.front[i][order[v]] = value(v);
            if (other[v] != RECEIVER_NONE) out.back[i][order[v]] = value(other[v]);
        }
    }
    return out;
}

std::map<std::string, std::string> transfer_convention(const TransferVectors& vectors,
                                                       const DynamicTransferOptions& options) {
    const MaskOptions& masks = options.masks;
    return {
        {"clgi:quantity", "transfer"},
        {"clgi:unit", "sr"},
        {"clgi:meaning",
         "integral over directions of basis function, visibility and clamped cosine to the vertex "
         "normal; the inner product with the light's coefficients (integral of radiance and basis "
         "function) is irradiance; reflectance and 1/pi are not included"},
        {"clgi:basis",
         "real spherical harmonics, orthonormal over the sphere, without the Condon-Shortley sign; "
         "polar axis +z; term l^2+l+m; terms 1, 2, 3 are sqrt(3/(4 pi)) times y, z, x"},
        {"clgi:frame", "world of the glTF file, +Y up"},
        {"clgi:order", std::to_string(vectors.bands - 1)},
        {"clgi:terms", std::to_string(sh::terms(vectors.bands))},
        {"clgi:window", options.window == sh::Window::hann      ? "hann"
                        : options.window == sh::Window::lanczos ? "lanczos"
                                                                : "none"},
        {"clgi:mask", fmt::format("{0}x{0}, cells of {1}x{1}", masks.size, masks.block)},
        {"clgi:vertices", std::to_string(vectors.vertices)},
        {"clgi:vertex_order",
         "primitives in the order in which clgi loads them; of each the vertices in use, rising"}};
}

io::Image transfer_image(const TransferVectors& vectors) {
    const auto count = static_cast<int>(vectors.vertices);
    io::Image out;
    out.width = std::min(count, most_columns);
    out.height = count == 0 ? 0 : (count + most_columns - 1) / most_columns;
    add_channels(out, "", vectors.front);
    add_channels(out, "back.", vectors.back);
    return out;
}

std::vector<io::VertexAttribute> transfer_attributes(const TransferVectors& vectors) {
    std::vector<io::VertexAttribute> out;
    add_attributes(out, "_TRANSFER_", vectors.front, false);
    add_attributes(out, "_TRANSFER_BACK_", vectors.back, true);
    return out;
}

}  // namespace clgi::lab
