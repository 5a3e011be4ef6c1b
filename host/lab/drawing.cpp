// SPDX-License-Identifier: MIT
#include "lab/drawing.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <clgi/error.hpp>
#include <clgi/io/image.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/atomic_file.hpp"
#include "io/image_formats.hpp"
#include "lab/embedded.hpp"

namespace clgi::lab {
namespace {

// Imports the program, which draws, and leaves a line in `why` if it cannot. Modules come from the
// folder in place of the user's.
std::string start_of(const std::string& program, const std::filesystem::path& folder) {
    return fmt::format(R"(import os, sys
sys.path = [{0}] + [path for path in sys.path if path]
os.chdir({0})
try:
    import {1}
except ImportError as error:
    why = f"{{error}}; plots need python3-matplotlib and python3-jinja2"
except Exception as error:
    why = f"plots/{1}.py: {{type(error).__name__}}: {{error}}"
else:
    sys.exit(0)
open("why", "w").write(why.replace("\n", " "))
sys.exit(1)
)",
                       nlohmann::json(folder.string()).dump(), program);
}

}  // namespace

void save_text(const std::filesystem::path& path, const std::string& text) {
    io::AtomicFile file(path);
    file.write(text.data(), text.size());
    file.commit();
}

Drawing::Drawing() {
    std::string name = std::filesystem::temp_directory_path() / "clgi-XXXXXX";
    if (!::mkdtemp(name.data())) throw InputError(name + ": cannot be made");
    folder_ = name;
}

Drawing::~Drawing() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

void Drawing::add(const std::string& name, const Raster& picture) const {
    io::save_png(picture.width, picture.height, picture.rgba, folder_ / name);
}

// Python reads its first lines from a pipe: no name of a user's ever reaches a shell. The first
// python3 of the path may lack packages that the system's has.
std::string Drawing::draw(const std::string& program, const nlohmann::ordered_json& data) const {
    for (unsigned i = 0; i < embedded_plot_count; ++i)
        save_text(folder_ / embedded_plots[i].name, embedded_plots[i].source);
    save_text(folder_ / "data.json",
              data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    const std::string start = start_of(program, folder_);
    for (const char* python : {"python3", "/usr/bin/python3"}) {
        const std::string command = fmt::format("{} -B - >/dev/null 2>&1", python);
        std::FILE* pipe = ::popen(command.c_str(), "w");
        if (!pipe) continue;
        std::fwrite(start.data(), 1, start.size(), pipe);
        if (::pclose(pipe) == 0) return "";
    }
    const std::string why = text("why");
    return why.empty() ? "python3 is not there" : why;
}

std::string Drawing::text(const std::string& name) const {
    std::ostringstream out;
    out << std::ifstream(folder_ / name).rdbuf();
    return out.str();
}

Raster Drawing::picture(const std::string& name) const {
    const io::Image image = io::read_image_or_png(folder_ / name);
    Raster out{image.width, image.height, {}};
    out.rgba.resize(4 * image.channels.front().values.size(), 255);
    for (std::size_t c = 0; c < image.channels.size(); ++c)
        for (std::size_t i = 0; i < out.rgba.size() / 4; ++i)
            out.rgba[4 * i + c] =
                static_cast<std::uint8_t>(std::lround(255.0f * image.channels[c].values[i]));
    return out;
}

}  // namespace clgi::lab
