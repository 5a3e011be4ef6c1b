// load_gltf: the steps from a file to a Scene.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <new>
#include <stdexcept>

#include "io/gltf_document.hpp"

namespace clgi::io {

namespace {

Scene load(const std::filesystem::path& path, const GltfOptions& options) {
    // Everything the document says is checked before anything is built from it.
    gltf::Document document = gltf::read_document(path);
    gltf::check_links(document.model);
    gltf::check_accessors(document);
    gltf::check_meshes(document);
    gltf::read_lights(document);
    gltf::place_nodes(document);

    Scene scene;
    scene.name = path.stem().string();
    gltf::load_materials(document, options, scene);
    const std::vector<int> nodes = gltf::scene_nodes(document, options.scene);
    gltf::place_meshes(document, nodes, options, scene);
    gltf::place_lights(document, nodes, scene);
    scene.warnings = document.warnings.lines();
    validate(scene);
    return scene;
}

}  // namespace

Scene load_gltf(const std::filesystem::path& path, const GltfOptions& options) {
    const auto refuse = [&](const char* what) {
        std::string line = path.string() + ": " + what;
        std::replace_if(
            line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
        return InputError(line);
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
