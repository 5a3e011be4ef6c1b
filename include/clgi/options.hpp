// Every option of a renderer by name: what it may be, which methods have it, what it is for. Flags
// of the program, its JSON and the key of a resumed bake come out of this table.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/renderer.hpp>
#include <functional>
#include <string>
#include <vector>

namespace clgi {

// Sets of methods; bakes are atlases without a picture (clgi bake), vectors transfer without light
// (clgi transfer).
enum Methods : unsigned {
    of_direct = 1u << static_cast<unsigned>(Method::direct),
    of_second_order = 1u << static_cast<unsigned>(Method::second_order),
    of_light_atlas = 1u << static_cast<unsigned>(Method::light_atlas),
    of_antiradiance = 1u << static_cast<unsigned>(Method::antiradiance),
    of_transfer = 1u << static_cast<unsigned>(Method::dynamic_transfer),
    of_irradiance_cache = 1u << static_cast<unsigned>(Method::irradiance_cache),
    of_bakes = 1u << 8,
    of_vectors = 1u << 9
};
constexpr unsigned methods_of(Method method) { return 1u << static_cast<unsigned>(method); }

struct OptionRow {
    enum class Kind { integer, number, choice, toggle };

    std::string name;   // "bins": the flag --bins, "bins" in JSON (with _ for -)
    std::string value;  // of the flag: "N"; empty: a toggle, on where the flag stands
    std::string help;   // a phrase, with its unit
    unsigned methods;   // that have it
    Kind kind;
    double least = 0.0, most = 0.0;    // of integers and numbers; equal: any that `set` takes
    std::vector<std::string> choices;  // of choices, and of integers that have few values

    std::function<std::string(const RendererOptions&)> get;
    // Throws Error that begins with the name for a text that is no such value.
    std::function<void(RendererOptions&, const std::string&)> set;

    bool of(unsigned which) const { return (methods & which) != 0; }
};

// In the order of help texts.
CLGI_API const std::vector<OptionRow>& option_table();

// Throws Error for a name that no row has, and for a value out of range.
CLGI_API const OptionRow& option(const std::string& name, unsigned methods = ~0u);
CLGI_API void set_option(RendererOptions& options, const std::string& name,
                         const std::string& value);

// "bins=128 elements=8192 ...", of all rows that these methods have.
CLGI_API std::string option_text(const RendererOptions& options, unsigned methods);

}  // namespace clgi
