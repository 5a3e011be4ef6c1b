// The images of a model: all looked at, those that materials need decoded into a Scene's textures.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/gltf.hpp>
#include <filesystem>
#include <map>
#include <tuple>

#include "io/gltf_document.hpp"
#include "io/gltf_image.hpp"

namespace clgi::io::gltf {

struct MetalRough {
    double metallic = 1.0;
    double roughness = 1.0;
};

class TextureLoader {
public:
    TextureLoader(Document& document, const std::filesystem::path& folder,
                  const GltfOptions& options, Scene& scene);

    // Every image, used or not, must exist and be what it says. To be called first.
    void check_images();

    // Index into scene.textures; -1 where there is no image that can be read.
    int load(int texture);

    // The means of a texture's blue and green, which multiply the factors.
    MetalRough mean_metal_rough(int texture);

private:
    void check_types(std::size_t image) const;
    bool is_readable(int image);
    Pixels decode(std::size_t image, std::size_t& budget);

    Document& document_;
    const std::filesystem::path& folder_;
    Scene& scene_;
    std::size_t texels_left_;
    std::size_t averaged_left_;
    std::size_t most_texels_;
    std::size_t encoded_ = 0;           // bytes
    std::vector<ImageFormat> formats_;  // of every image
    std::map<std::tuple<int, Wrap, Wrap, bool>, int> loaded_;
    std::map<int, MetalRough> means_;
};

}  // namespace clgi::io::gltf
