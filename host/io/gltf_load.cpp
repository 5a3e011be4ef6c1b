// load_gltf: the steps from a file to a Scene.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <new>
#include <stdexcept>

#include "io/gltf_accessor.hpp"
#include "io/gltf_check.hpp"
#include "io/gltf_material.hpp"
#include "io/gltf_parse.hpp"
#include "io/gltf_place.hpp"
#include "io/gltf_tree.hpp"

namespace clgi::io {

namespace {

// Everything the document says is checked before anything is built from it.
gltf::Document open_document(const std::filesystem::path& path) {
    gltf::Document document = gltf::parse(path);
    gltf::check_links(document.model);
    gltf::check_accessors(document);
    gltf::check_meshes(document);
    gltf::read_lights(document);
    gltf::place_nodes(document);
    return document;
}

Scene load(const std::filesystem::path& path, const GltfOptions& options) {
    gltf::Document document = open_document(path);
    Scene scene;
    scene.name = path.stem().string();
    gltf::load_materials(document, path.parent_path(), options, scene);
    const std::vector<int> nodes = gltf::scene_nodes(document, options.scene);
    gltf::place_meshes(document, nodes, options, scene);
    gltf::place_lights(document, nodes, scene);
    gltf::place_cameras(document, nodes, scene);
    scene.warnings = document.warnings.lines();
    validate(scene);
    return scene;
}

std::string one_line(std::string text) {
    for (char& c : text) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    return text;
}

}  // namespace

Scene load_gltf(const std::filesystem::path& path, const GltfOptions& options) {
    const auto refuse = [&](const std::string& what) {
        return InputError(one_line(path.string() + ": " + what));
    };
    try {
        return load(path, options);
    } catch (const InputError& error) {
        throw refuse(error.what());
    } catch (const std::bad_alloc&) {
        throw refuse("needs more memory than there is");
    } catch (const std::length_error&) {
        throw refuse("needs more memory than there is");
    }
}

}  // namespace clgi::io
