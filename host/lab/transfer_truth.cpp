// SPDX-License-Identifier: MIT
#include "lab/transfer_truth.hpp"

#include <algorithm>
#include <clgi/advanced/sh.hpp>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <numeric>
#include <random>

namespace clgi::lab {
namespace {

std::vector<std::uint32_t> some_vertices(const Scene& scene, std::size_t wanted) {
    std::vector<std::uint32_t> out(scene.positions.size());
    std::iota(out.begin(), out.end(), 0u);
    std::mt19937 random(1);
    const std::size_t count = std::min(wanted, out.size());
    for (std::size_t i = 0; i < count; ++i)  // not std::shuffle: it differs between libraries
        std::swap(out[i], out[i + random() % (out.size() - i)]);
    out.resize(count);
    std::sort(out.begin(), out.end());
    return out;
}

double square_of(const double* vector, std::size_t terms) {
    return std::inner_product(vector, vector + terms, vector, 0.0);
}

double square_between(const double* a, const double* b, std::size_t terms) {
    double sum = 0.0;
    for (std::size_t i = 0; i < terms; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

}  // namespace

TransferTruth transfer_truth(const Scene& scene, std::size_t vertices) {
    constexpr int frames = 8, strata = 64, bands = 5;  // strata: a side
    if (!scene.animation || scene.animation->clips.empty())
        throw Error("transfer_truth: the scene has no animation");
    TransferTruth out;
    out.vertices = some_vertices(scene, vertices);
    for (int frame = 0; frame < frames; ++frame) {
        const double time = scene.animation->clips[0].duration * (frame + 0.5) / frames;
        const Scene still = posed(scene, pose_at(*scene.animation, 0, time));
        const reference::PathTracer tracer(still);
        std::vector<reference::Place> places;
        for (const std::uint32_t v : out.vertices)
            places.push_back({still.positions[v], still.normals[v]});
        out.seconds.push_back(time);
        out.vectors.push_back(tracer.transfer(places, bands, strata, 1));
        if (frame > 0) continue;
        TransferErrors between;
        between.add(tracer.transfer(places, bands, strata, 2), out.vectors[0], bands);
        out.noise = between.error().mean / std::sqrt(2.0);  // both have it
    }
    return out;
}

void TransferErrors::add(const std::vector<double>& vectors, const std::vector<double>& truth,
                         int bands) {
    const auto terms = static_cast<std::size_t>(sh::terms(bands));
    if (vectors.size() != truth.size() || truth.size() % terms != 0)
        throw Error("transfer_truth: " + std::to_string(vectors.size()) + " numbers, " +
                    std::to_string(truth.size()) + " needed");
    const std::vector<double> open = sh::around({0, 0, 1}, sh::cosine_kernel(bands));
    const double whole = square_of(open.data(), terms);
    for (std::size_t at = 0; at < truth.size(); at += terms) {
        const double all = square_of(truth.data() + at, terms);
        if (all < 1e-6 * whole) {
            ++sums_.left_out;
            continue;
        }
        const double off = square_between(vectors.data() + at, truth.data() + at, terms);
        sums_.mean += std::sqrt(off / all);
        sums_.root += off;
        all_ += all;
        ++sums_.counted;
        if (all < 1e-2 * whole) continue;
        sums_.lit += std::sqrt(off / all);
        ++sums_.counted_lit;
    }
}

TransferError TransferErrors::error() const {
    TransferError out = sums_;
    if (out.counted > 0) out.mean /= static_cast<double>(out.counted);
    if (out.counted > 0) out.root = std::sqrt(out.root / all_);
    if (out.counted_lit > 0) out.lit /= static_cast<double>(out.counted_lit);
    return out;
}

}  // namespace clgi::lab
