// Animations are not played; this only refuses files whose animations refer to what is not there.
// SPDX-License-Identifier: MIT
#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

namespace {

struct Curve {
    std::size_t keys = 0;
    const Accessor* output = nullptr;
    std::size_t values_a_key = 1;  // 3 for a cubic spline: tangent, value, tangent
};

Curve read_sampler(const Value& value, const Document& document) {
    const std::size_t accessors = document.accessors.size();
    const Accessor& input = document.accessors[value.at("input").index(accessors, "accessors")];
    if (input.component != Component::float32 || input.rows != 1) {
        value.at("input").fail("is not an accessor of float scalars");
    }
    Curve curve;
    curve.keys = input.count;
    curve.output = &document.accessors[value.at("output").index(accessors, "accessors")];
    const auto interpolation = value.find("interpolation");
    if (interpolation && interpolation->text() == "CUBICSPLINE") curve.values_a_key = 3;
    return curve;
}

void check_channel(const Value& value, const std::vector<Curve>& curves, const Document& document) {
    const Curve& curve = curves[value.at("sampler").index(curves.size(), "samplers")];
    const Value target = value.at("target");
    const int node = target.index_or_none("node", document.nodes.size(), "nodes");
    const std::string path = target.at("path").text();
    int rows = 0;
    if (path == "translation" || path == "scale") rows = 3;
    if (path == "rotation") rows = 4;
    if (path == "weights") rows = 1;
    if (rows == 0 || node < 0) return;  // of an extension
    if (curve.output->rows != rows) value.fail("has key values of the wrong shape");

    std::size_t values = curve.values_a_key;
    if (path == "weights") {
        const int mesh = document.nodes[node].mesh;
        if (mesh < 0 || document.meshes[mesh].primitives[0].targets.empty()) return;
        values *= document.meshes[mesh].primitives[0].targets.size();
    }
    if (curve.output->count / values != curve.keys || curve.output->count % values != 0) {
        value.fail("has " + std::to_string(curve.output->count) + " values for " +
                   std::to_string(curve.keys) + " keys");
    }
}

}  // namespace

void check_animations(const Value& root, const Document& document) {
    const std::size_t animations = entries(root, "animations", max_rare_entries);
    for (std::size_t i = 0; i < animations; ++i) {
        const Value animation = root.at("animations").item(i);
        const Value samplers = animation.at("samplers");
        const Value channels = animation.at("channels");
        std::vector<Curve> curves;
        for (std::size_t k = 0; k < samplers.count(); ++k) {
            curves.push_back(read_sampler(samplers.item(k), document));
        }
        for (std::size_t k = 0; k < channels.count(); ++k) {
            check_channel(channels.item(k), curves, document);
        }
    }
}

}  // namespace clgi::io::gltf
