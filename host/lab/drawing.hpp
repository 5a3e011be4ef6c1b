// What matplotlib and jinja2 draw, where they are installed: plots, sheets and pages, by the Python
// programs of host/lab/plots.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace clgi::lab {

// An 8-bit picture to be saved as PNG.
struct Raster {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  // [height][width][4], sRGB, row 0 at the top
};

// A drawing and the temporary folder where it is made. Throws InputError where no file can be
// written.
class Drawing {
public:
    Drawing();
    ~Drawing();
    Drawing(const Drawing&) = delete;
    Drawing& operator=(const Drawing&) = delete;

    // Adds a picture that the program reads. name: "panel.png"
    void add(const std::string& name, const Raster& picture) const;

    // Runs a program of host/lab/plots, which finds `data` as data.json beside the pictures.
    // Returns nothing, or why nothing was drawn, as a line to print.
    std::string draw(const std::string& program, const nlohmann::ordered_json& data) const;

    // What the program drew: the text of a file, empty where there is none, and a picture.
    std::string text(const std::string& name) const;
    Raster picture(const std::string& name) const;

private:
    std::filesystem::path folder_;
};

void save_text(const std::filesystem::path& path, const std::string& text);

}  // namespace clgi::lab
