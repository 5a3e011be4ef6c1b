// Light between elements that a test makes by hand: on the device, and by the definition.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/passes/antiradiance.hpp>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "device.hpp"

namespace clgi::test {

struct HandLink {
    std::uint32_t sender, receiver, bin;
    float form_factor;
};

// Elements in depth-first order.
struct HandElements {
    std::vector<glm::vec4> directions;  // xyz: unit; w: sr
    std::vector<Element> elements;
    std::vector<HandLink> links;
    std::vector<glm::vec4> sky, sources, reflectances;  // of bins; of leaves

    std::uint32_t bins() const { return static_cast<std::uint32_t>(directions.size()); }
    bool is_leaf(std::uint32_t i) const { return elements[i].end == i + 1; }

    explicit HandElements(std::vector<glm::vec4> of)
        : directions(std::move(of)), sky(directions.size(), glm::vec4(0.0f)) {}

    // A leaf below the last inner element that is still open, or alone.
    std::uint32_t leaf(std::uint32_t parent, const glm::vec3& normal, float area,
                       const glm::vec3& source, const glm::vec3& reflectance) {
        const auto i = static_cast<std::uint32_t>(elements.size());
        const auto row = static_cast<std::uint32_t>(sources.size());
        elements.push_back({glm::vec4(normal, area), parent, i + 1, row, 0, 0, 0, 0, 0});
        sources.emplace_back(source, 0.0f);
        reflectances.emplace_back(reflectance, 0.0f);
        return i;
    }
    // normal: of all below; 0: they differ.
    std::uint32_t inner(std::uint32_t parent, const glm::vec3& normal = glm::vec3(0.0f)) {
        const auto i = static_cast<std::uint32_t>(elements.size());
        const auto row = static_cast<std::uint32_t>(elements.size() - sources.size());
        elements.push_back({glm::vec4(normal, 0.0f), parent, i + 1, row, 0, 0, 0, 0, 0});
        return i;
    }
    // What the sender has before it in the link's bin; not above 0: the link reads a row.
    float cosine(const HandLink& link) const {
        return glm::dot(glm::vec3(elements[link.sender].normal), glm::vec3(directions[link.bin]));
    }
    void close(std::uint32_t i) { elements[i].end = static_cast<std::uint32_t>(elements.size()); }
};

// One step after another, in double.
class LightByDefinition {
public:
    explicit LightByDefinition(const HandElements& of)
        : of_(of),
          exitant(of.elements.size() * of.bins(), glm::dvec3(0.0)),
          radiances(of.sources.size(), glm::dvec3(0.0)),
          irradiances(of.sources.size(), glm::dvec3(0.0)) {}

    void step(std::uint32_t flags) {
        const std::uint32_t bins = of_.bins();
        std::vector<glm::dvec3> arrives(exitant.size(), glm::dvec3(0.0)), next = exitant;
        if (flags & LOCAL_RECEIVE)
            for (std::size_t at = 0; at < arrives.size(); ++at)
                arrives[at] = glm::dvec3(of_.sky[at % bins]);
        // A link brings light to all below its receiver.
        if (flags & LOCAL_RECEIVE)
            for (const HandLink& link : of_.links)
                for (std::uint32_t i = link.receiver; i < of_.elements[link.receiver].end; ++i)
                    arrives[i * bins + link.bin] +=
                        double(link.form_factor) * exitant[link.sender * bins + link.bin];
        for (std::uint32_t i = 0; i < of_.elements.size(); ++i) {
            if (!of_.is_leaf(i)) continue;
            const Element& leaf = of_.elements[i];
            const glm::dvec3 normal(leaf.normal);
            glm::dvec3 arrived(0.0);
            for (std::uint32_t b = 0; b < bins; ++b)
                arrived += of_.directions[b].w *
                           std::max(0.0, -glm::dot(normal, glm::dvec3(of_.directions[b]))) *
                           arrives[i * bins + b];
            irradiances[leaf.row] = arrived;
            if (flags & LOCAL_REFLECT)
                radiances[leaf.row] =
                    glm::dvec3(of_.sources[leaf.row]) +
                    glm::dvec3(of_.reflectances[leaf.row]) / 3.14159265358979323846 * arrived;
            for (std::uint32_t b = 0; b < bins; ++b) {
                const double scale =
                    leaf.normal.w * glm::dot(normal, glm::dvec3(of_.directions[b]));
                if (scale > 0.0)
                    next[i * bins + b] = scale * radiances[leaf.row];
                else if (flags & LOCAL_GO_THROUGH)
                    next[i * bins + b] = scale * arrives[i * bins + b];
            }
        }
        for (std::uint32_t i = 0; i < of_.elements.size(); ++i) {
            if (of_.is_leaf(i)) continue;
            for (std::uint32_t b = 0; b < bins; ++b) {
                next[i * bins + b] = glm::dvec3(0.0);
                for (std::uint32_t k = i + 1; k < of_.elements[i].end; ++k)
                    if (of_.is_leaf(k)) next[i * bins + b] += next[k * bins + b];
            }
        }
        exitant = next;
    }

private:
    const HandElements& of_;

public:
    std::vector<glm::dvec3> exitant;                 // [elements][bins]
    std::vector<glm::dvec3> radiances, irradiances;  // [leaves]
};

// The same with the passes.
class LightOnDevice {
public:
    LightOnDevice(const HandElements& of, const BuildOptions& how)
        : passes_(programs(), static_cast<int>(of.bins()), how),
          half_(how.storage == Storage::half) {
        const auto count = static_cast<std::uint32_t>(of.elements.size());
        std::vector<std::uint32_t> first, level(count);
        std::vector<std::uint32_t> senders;
        std::vector<std::uint16_t> bins;
        std::vector<float> factors;
        std::vector<Element> elements = of.elements;
        for (Element& element : elements) element.sends = ELEMENT_NONE;
        for (const HandLink& link : of.links)
            for (std::uint32_t i = link.sender; i < of.elements[link.sender].end; ++i)
                if (!(of.cosine(link) > 0.0f)) elements[i].sends = 0;
        for (std::uint32_t i = 0; i < count; ++i)
            if (elements[i].sends == 0) {
                elements[i].sends = static_cast<std::uint32_t>(with_rows.size());
                with_rows.push_back(i);
            }
        for (std::uint32_t i = 0; i < count; ++i) {
            for (const bool before : {true, false}) {
                first.push_back(static_cast<std::uint32_t>(senders.size()));
                for (const HandLink& link : of.links) {
                    const float cosine = of.cosine(link);
                    if (link.receiver != i || (cosine > 0.0f) != before) continue;
                    senders.push_back(before ? link.sender : elements[link.sender].sends);
                    bins.push_back(static_cast<std::uint16_t>(link.bin));
                    factors.push_back(before ? link.form_factor * cosine : link.form_factor);
                }
            }
            const std::uint32_t parent = of.elements[i].parent;
            level[i] = parent == ELEMENT_NONE ? 0 : level[parent] + 1;
            std::vector<std::uint32_t>& list = of.is_leaf(i) ? leaves_ : inner_;
            if (!of.is_leaf(i)) levels_ = std::max(levels_, level[i] + 1);
            list.push_back(i);
        }
        links_.link_count = static_cast<std::uint32_t>(senders.size());
        first.push_back(links_.link_count);
        std::stable_sort(inner_.begin(), inner_.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return level[a] < level[b]; });
        for (std::uint32_t l = 0; l <= levels_; ++l)
            begins_.push_back(static_cast<std::uint32_t>(
                std::find_if(inner_.begin(), inner_.end(),
                             [&](std::uint32_t i) { return level[i] >= l; }) -
                inner_.begin()));
        if (senders.empty()) {
            senders.push_back(0);
            bins.push_back(0);
            factors.push_back(0.0f);
        }
        links_.elements = upload(elements);
        links_.first_links = upload(first);
        links_.senders = upload(senders);
        links_.bins = upload(bins);
        links_.form_factors = upload(factors);
        links_.element_count = count;
        links_.row_count = static_cast<std::uint32_t>(with_rows.size());
        links_.inner_count = static_cast<std::uint32_t>(inner_.size());
        links_.leaf_count = static_cast<std::uint32_t>(leaves_.size());
        rows_.sky = upload(of.sky);
        rows_.incident =
            empty<glm::vec4>(std::max<std::size_t>(inner_.size(), 1) * of.directions.size());
        const std::vector<char> nothing(passes_.intensity_bytes(with_rows.size()), 0);
        rows_.exitant = upload(nothing);
        rows_.next = upload(nothing);
        rows_.powers = upload(std::vector<glm::vec4>(count, glm::vec4(0.0f)));
        rows_.next_powers = upload(std::vector<glm::vec4>(count, glm::vec4(0.0f)));
        const std::vector<glm::vec4> dark(leaves_.size(), glm::vec4(0.0f));
        light = {upload(of.sources), upload(of.reflectances),        upload(dark), upload(dark),
                 upload(dark),       upload(std::vector<cl_uint>{0})};
        directions_ = upload(of.directions);
        leaf_list_ = upload(leaves_);
        inner_list_ = upload(inner_.empty() ? std::vector<std::uint32_t>{0} : inner_);
    }

    void step(std::uint32_t flags) {
        const cl::CommandQueue& queue = device().queue;
        const auto level = [&](std::uint32_t l) {
            return ElementParams{begins_[l], begins_[l + 1] - begins_[l], 0, 0};
        };
        for (std::uint32_t l = 0; l < levels_; ++l)
            passes_.global(queue, level(l), inner_list_, links_, rows_);
        passes_.local(queue, {0, links_.leaf_count, flags, 0}, leaf_list_, links_, rows_,
                      directions_, light);
        for (std::uint32_t l = levels_; l-- > 0;)
            passes_.pull(queue, level(l), inner_list_, links_, rows_);
        std::swap(rows_.exitant, rows_.next);
        std::swap(rows_.powers, rows_.next_powers);
    }

    // [with_rows][bins]
    std::vector<glm::vec4> exitant() const {
        const std::size_t count = with_rows.size() * static_cast<std::size_t>(passes_.bins());
        if (!half_) return download<glm::vec4>(rows_.exitant, count);
        std::vector<glm::vec4> out;
        for (const std::uint64_t four : download<std::uint64_t>(rows_.exitant, count))
            out.push_back(glm::unpackHalf4x16(four));
        return out;
    }

    // The same of what the definition gives for all elements.
    std::vector<glm::dvec3> rows_of(const std::vector<glm::dvec3>& all) const {
        const auto bins = static_cast<std::size_t>(passes_.bins());
        std::vector<glm::dvec3> out;
        for (const std::size_t i : with_rows)
            for (std::size_t b = 0; b < bins; ++b) out.push_back(all[i * bins + b]);
        return out;
    }

    std::vector<std::uint32_t> with_rows;  // elements whose rows links read, and all below them
    LeafBuffers light;

private:
    AntiradiancePasses passes_;
    bool half_;
    std::vector<std::uint32_t> leaves_, inner_, begins_;
    std::uint32_t levels_ = 0;
    LinkBuffers links_;
    ElementRows rows_;
    cl::Buffer directions_, leaf_list_, inner_list_;
};

}  // namespace clgi::test
