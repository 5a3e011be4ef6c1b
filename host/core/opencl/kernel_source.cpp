// Kernels as self-contained text: every include resolved once, #line and comments kept, as
// cmake/FlattenKernel.cmake writes them for programs that take the kernels alone.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kernel_source.hpp>
#include <clgi/error.hpp>
#include <set>
#include <string_view>

#include "core/opencl/embedded.hpp"

namespace clgi {
namespace {

constexpr std::string_view folder = "kernels/", ending = ".cl";

const char* find(const std::string& name) {
    for (unsigned i = 0; i < embedded_file_count; ++i)
        if (name == embedded_files[i].name) return embedded_files[i].text;
    return nullptr;
}

std::string file_of(const std::string& kernel) {
    return std::string(folder) + kernel + std::string(ending);
}

// What a line includes; empty for any other line.
std::string included(std::string_view line) {
    constexpr std::string_view opening = "#include \"";
    if (line.substr(0, opening.size()) != opening) return "";
    const std::string_view rest = line.substr(opening.size());
    return std::string(rest.substr(0, rest.find('"')));
}

class Flattener {
public:
    void append(const std::string& file) {
        const char* text = find(file);
        if (!text) throw Error("program: no embedded file is called " + file);
        add_line_directive(1, file);
        int number = 0;
        for (std::string_view rest = text; !rest.empty();) {
            const std::size_t end = std::min(rest.find('\n'), rest.size());
            const std::string_view line = rest.substr(0, end);
            rest.remove_prefix(std::min(end + 1, rest.size()));
            ++number;
            const std::string name = included(line);
            if (name.empty()) {
                out_.append(line).append("\n");
                continue;
            }
            if (seen_.insert(name).second)
                append((name.rfind("clgi/", 0) == 0 ? "include/" : "kernels/") + name);
            add_line_directive(number + 1, file);
        }
    }

    std::string take() { return std::move(out_); }

private:
    void add_line_directive(int line, const std::string& file) {
        out_ += "#line " + std::to_string(line) + " \"" + file + "\"\n";
    }

    std::string out_;
    std::set<std::string> seen_;
};

}  // namespace

std::vector<std::string> kernel_names() {
    std::vector<std::string> out;
    for (unsigned i = 0; i < embedded_file_count; ++i) {
        const std::string_view name = embedded_files[i].name;
        if (name.substr(0, folder.size()) != folder || name.size() < ending.size() ||
            name.substr(name.size() - ending.size()) != ending)
            continue;
        out.emplace_back(name.substr(folder.size(), name.size() - folder.size() - ending.size()));
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::string kernels_source(const std::vector<std::string>& names) {
    Flattener flattener;
    for (const std::string& name : names) {
        if (!find(file_of(name))) throw Error("program: no embedded kernel is called " + name);
        flattener.append(file_of(name));
    }
    return flattener.take();
}

std::string kernel_source(const std::string& name) { return kernels_source({name}); }

}  // namespace clgi
