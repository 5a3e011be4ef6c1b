// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/options.hpp>
#include <initializer_list>

#include "renderer/option_rows.hpp"

namespace clgi {
namespace {

using namespace renderer;

constexpr unsigned pictures = of_second_order | of_direct;
constexpr unsigned shown =
    pictures | of_light_atlas | of_antiradiance | of_transfer | of_irradiance_cache;
OptionRow row(const char* name, const char* value, unsigned methods, const char* help,
              double least = 0.0, double most = 0.0,
              std::initializer_list<const char*> choices = {}) {
    OptionRow out;
    out.name = name;
    out.value = value;
    out.help = help;
    out.methods = methods;
    out.kind = OptionRow::Kind::number;
    out.least = least;
    out.most = most;
    out.choices.assign(choices.begin(), choices.end());
    return out;
}

using O = RendererOptions;

std::vector<OptionRow> of_pictures() {
    return {
        number(row("vpls", "N", of_second_order | of_light_atlas,
                   "VPLs of all emitters together; atlas: on all surfaces", 0, 1 << 20),
               [](O& o) -> Number {
                   if (o.method == Method::light_atlas) return &o.vpls.count;
                   return &o.second_order.emitters.vpls;
               },
               {[](O& o) -> Number { return &o.second_order.emitters.vpls; },
                [](O& o) -> Number { return &o.vpls.count; }}),
        number(row("negative-vpls", "N", of_second_order, "Negative VPLs; 0: none", 0, 1 << 20),
               [](O& o) -> Number { return &o.second_order.negative_vpls; }),
        threshold(
            row("low-res", "off|T", of_second_order,
                "Discontinuity threshold; off or 0: every pixel is gathered, inf: none"),
            {{"off", -1.0}},
            [](const O& o) {
                return o.second_order.low_resolution_step == 1
                           ? -1.0
                           : double{o.second_order.discontinuity_threshold};
            },
            [](O& o, double value) {
                if (value < 0.0)
                    o.second_order.low_resolution_step = 1;
                else
                    o.second_order.discontinuity_threshold = static_cast<float>(value);
            }),
        number(row("low-res-step", "N", of_second_order, "Pixels between low-resolution points", 2,
                   4, {"2", "4"}),
               [](O& o) -> Number { return &o.second_order.low_resolution_step; }),
        number(row("shadow-size", "N", shown,
                   "Pixels per side of the shadow map of a spot or directional light", 1, 8192),
               [](O& o) -> Number { return &o.picture.emitters.shadow_size; },
               {[](O& o) -> Number { return &o.light_atlas.emitters.shadow_size; }}),
        number(row("face-size", "N", shown | of_bakes,
                   "Pixels per side of a cube or hemicube face, for point and area lights; cache: "
                   "half as many for area lights",
                   1, 4096),
               [](O& o) -> Number { return &o.picture.emitters.face_size; },
               {[](O& o) -> Number { return &o.light_atlas.emitters.face_size; }}),
        number(row("area-samples", "N", shown | of_bakes,
                   "Sample points on all emissive surfaces together", 0, 4096),
               [](O& o) -> Number { return &o.picture.emitters.area_samples; },
               {[](O& o) -> Number { return &o.light_atlas.emitters.area_samples; }}),
        number(row("environment-lights", "N", pictures | of_light_atlas | of_bakes,
                   "Directional lights that approximate the environment", 0, 4096),
               [](O& o) -> Number { return &o.picture.emitters.environment_lights; },
               {[](O& o) -> Number { return &o.light_atlas.emitters.environment_lights; }}),
        number(row("samples", "N", shown,
                   "Views of a picture through other points of its pixels, which is their mean", 1,
                   65536),
               [](O& o) -> Number { return &o.samples; }),
        toggle(
            row("no-direct", "", shown & ~of_transfer,
                "Leave out direct light, emission and the environment"),
            [](O& o) -> bool& { return o.picture.direct; }, false),
    };
}

std::vector<OptionRow> of_bake() {
    constexpr unsigned atlas = of_light_atlas | of_bakes;
    return {
        number(row("bounces", "N", atlas,
                   "Reflections of light at most before it reaches a texel; 0: all that matter", 0,
                   1000),
               [](O& o) -> Number { return &o.light_atlas.bounces; }),
        number(row("hemicube-size", "N", atlas, "Pixels of the face of a VPL's hemicube", 32, 1024),
               [](O& o) -> Number { return &o.light_atlas.hemicube_size; }),
        number(row("refine", "N", atlas,
                   "Texels between those that look up every VPL first; 1: all of them do", 1, 4,
                   {"1", "2", "4"}),
               [](O& o) -> Number { return &o.light_atlas.refine; }),
        number(row("atlas-size", "N", atlas, "Texels, side of a page of the atlas", 1, 8192),
               [](O& o) -> Number { return &o.layout.size; }),
        share(row("least-change", "X", of_light_atlas,
                  "with --spin-light: change of a VPL's power that lights texels anew, of the mean "
                  "power of VPLs"),
              [](O& o) -> Number { return &o.least_change; }),
        number(row("vpls", "N", of_bakes, "Virtual point lights (VPLs)", 1, 1 << 20),
               [](O& o) -> Number { return &o.vpls.count; }),
        number(row("shadow-size", "N", of_bakes,
                   "Pixels per side of the shadow map of a spot or directional light; 0: 2048, "
                   "fewer if there are more than 4 such maps",
                   0, 8192),
               [](O& o) -> Number { return &o.light_atlas.emitters.shadow_size; }),
        share(row("threshold", "X", of_bakes,
                  "With --bounces 0: largest unshot power of a VPL, of the mean direct power of "
                  "VPLs"),
              [](O& o) -> Number { return &o.light_atlas.threshold; }),
        number(
            row("samples-per-vpl", "N", of_bakes,
                "Sample points of a VPL that receive direct light and send it on near by", 1, 4096),
            [](O& o) -> Number { return &o.vpls.samples_per_vpl; }),
        number(
            row("gap-density", "X", of_bakes,
                "VPLs on narrow surfaces, between which light passes through gaps: so many times "
                "as dense at most; 1: as elsewhere",
                1, 1000),
            [](O& o) -> Number { return &o.vpls.gap_density; }),
        number(row("exchange-samples", "N", of_bakes,
                   "Those of them that tell how much of a VPL another one sees; 0: 4 to 16, fewer "
                   "for more VPLs",
                   0, 4096),
               [](O& o) -> Number { return &o.light_atlas.exchange_samples; }),
        toggle(row("one-at-a-time", "", of_bakes,
                   "With --bounces 0: shoot the strongest VPL alone, as in the paper"),
               [](O& o) -> bool& { return o.light_atlas.one_at_a_time; }),
        choice(
            row("filling", "HOW", of_bakes,
                "How texels get light: gather, or project as in the paper", 0, 0,
                {"gather", "project"}),
            [](O& o) -> Filling& { return o.light_atlas.filling; },
            std::vector{Filling::gather, Filling::project}),
        number(
            row("mesh", "N", of_bakes,
                "With --filling project: triangles of the mesh over a hemicube's face", 8, 131072),
            [](O& o) -> Number { return &o.light_atlas.mesh; }),
        number(row("kernel", "K", of_bakes,
                   "With --filling project: pixels to each side for soft shadows; 0: hard ones", 0,
                   64),
               [](O& o) -> Number { return &o.light_atlas.kernel; }),
        toggle(row("direct", "", of_bakes, "Direct light in the atlas too"),
               [](O& o) -> bool& { return o.light_atlas.direct; }),
        choice(
            row("uvs", "WHAT", of_bakes, "Where texels are: auto, 0, 1 (UV sets) or charts", 0, 0,
                {"auto", "0", "1", "charts"}),
            [](O& o) -> AtlasUvs& { return o.layout.uvs; },
            std::vector{AtlasUvs::automatic, AtlasUvs::set_0, AtlasUvs::set_1, AtlasUvs::charts}),
        number(row("texels-per-metre", "X", of_bakes, "Density of charts; 0: what fills the pages",
                   0, 1e6),
               [](O& o) -> Number { return &o.layout.texels_per_metre; }),
        number(row("pages", "N", of_bakes, "Pages at most, for charts", 1, 64),
               [](O& o) -> Number { return &o.layout.most_pages; }),
        number(row("padding", "N", of_bakes, "Empty texels around a chart", 1, 64),
               [](O& o) -> Number { return &o.layout.padding; }),
    };
}

std::vector<OptionRow> of_masks() {
    constexpr unsigned vectors = of_transfer | of_vectors;
    return {
        choice(
            row("sh-order", "N", vectors, "Highest degree of spherical harmonics; 4 has 25 terms",
                0, sh::most_bands - 1, {"0", "1", "2", "3", "4", "5", "6", "7", "8"}),
            [](O& o) -> int& { return o.transfer.masks.bands; },
            std::vector{1, 2, 3, 4, 5, 6, 7, 8, 9}),
        number(row("mask", "N", vectors, "Pixels, width of a visibility mask", 8, 128,
                   {"8", "16", "32", "64", "128"}),
               [](O& o) -> Number { return &o.transfer.masks.size; }),
        threshold(
            row("table", "N", vectors,
                "Size of the table of half-planes; 0: none, planes are exact", 0, 512,
                {"0", "16", "32", "64", "128", "256", "512"}),
            {},
            [](const O& o) {
                const MaskOptions& masks = o.transfer.masks;
                return masks.planes == EdgePlanes::table ? double(masks.table_size) : 0.0;
            },
            [](O& o, double value) {
                o.transfer.masks.planes = value > 0.0 ? EdgePlanes::table : EdgePlanes::exact;
                if (value > 0.0) o.transfer.masks.table_size = static_cast<int>(value);
            }),
        number(row("mask-block", "N", vectors,
                   "Pixels, width of the cells of a mask that are integrated", 1, 8,
                   {"1", "2", "4", "8"}),
               [](O& o) -> Number { return &o.transfer.masks.block; }),
        choice(
            row("sh-window", "WHAT", vectors, "Window against ringing", 0, 0,
                {"none", "hann", "lanczos"}),
            [](O& o) -> sh::Window& { return o.transfer.window; },
            std::vector{sh::Window::none, sh::Window::hann, sh::Window::lanczos}),
        number(row("rings", "N", vectors,
                   "With --coarse: edges from a vertex up to which the scene itself blocks", 0, 2),
               [](O& o) -> Number { return &o.transfer.rings; }),
        threshold(
            row("per-pixel", "off|all|X", of_transfer,
                "Difference from the light between vertices at which pixels have masks of "
                "their own; off: none, all"),
            {{"off", infinity}, {"all", 0.0}},
            [](const O& o) { return double{o.transfer_view.threshold}; },
            [](O& o, double value) { o.transfer_view.threshold = static_cast<float>(value); }),
        number(row("interreflections", "N", of_transfer,
                   "Times that light is reflected diffusely before it reaches what is seen", 0, 1),
               [](O& o) -> Number { return &o.transfer.interreflections; }),
        number(row("probe-step", "N", of_transfer,
                   "Pixels between the probes that --per-pixel compares", 2, 64),
               [](O& o) -> Number { return &o.transfer_view.probe_step; }),
    };
}

std::vector<OptionRow> of_elements() {
    return {
        number(row("bins", "N", of_antiradiance, "Bins of directions, a multiple of 4", 32, 4096),
               [](O& o) -> Number { return &o.antiradiance.bins; }),
        number(row("elements", "N", of_antiradiance, "Parts that surfaces are cut to, about", 1,
                   1 << 24),
               [](O& o) -> Number { return &o.antiradiance.elements.requested; }),
        number(row("poses", "N", of_antiradiance,
                   "Poses of the animation that links are made for, with --fps", 3, 200),
               [](O& o) -> Number { return &o.poses; }),
        choice(
            row("iteration", "KIND", of_antiradiance,
                "How reflections and light that is let through alternate; auto: symmetric, "
                "unless that diverges",
                0, 0, {"auto", "symmetric", "asymmetric"}),
            [](O& o) -> Iteration& { return o.antiradiance.iteration; },
            std::vector{Iteration::automatic, Iteration::symmetric, Iteration::asymmetric}),
        number(row("iterations", "N", of_antiradiance,
                   "Steps; 0: until the residual is below --residual", 0, 10000),
               [](O& o) -> Number { return &o.antiradiance.steps; }),
        number(row("residual", "X", of_antiradiance,
                   "Change in a step at which it ends, of the light that arrives", 1e-6, 1.0),
               [](O& o) -> Number { return &o.antiradiance.residual; }),
        number(row("least-gloss", "X", of_antiradiance,
                   "Share of all light above which lobes count; 1: none does", 0.0, 1.0),
               [](O& o) -> Number { return &o.antiradiance.least_gloss; }),
        number(
            row("bin-share", "X", of_antiradiance,
                "Size at which linked elements are refined, of a bin's solid angle", 0.0, infinity),
            [](O& o) -> Number { return &o.antiradiance.links.bin_share; }),
        choice(
            row("spread", "KIND", of_antiradiance,
                "How light from what is larger than a bin arrives in bins", 0, 0,
                {"precise", "gaussian", "none"}),
            [](O& o) -> Spread& { return o.antiradiance.links.spread; },
            std::vector{Spread::precise, Spread::gaussian, Spread::none}),
    };
}

std::vector<OptionRow> of_records() {
    return {
        number(row("seen", "N", of_irradiance_cache, "Records on what the picture shows, about", 1,
                   20000),
               [](O& o) -> Number { return &o.cache.seen; }),
        number(row("met", "N", of_irradiance_cache,
                   "Records on what those see, and what these see in turn", 0, 20000),
               [](O& o) -> Number { return &o.cache.met; }),
        number(
            row("refined", "N", of_irradiance_cache,
                "Records more where light changes between those that the picture shows", 0, 20000),
            [](O& o) -> Number { return &o.cache.refined; }),
        number(row("face", "N", of_irradiance_cache,
                   "Pixels of the face of a record's hemicube, a multiple of 8", 8, 256),
               [](O& o) -> Number { return &o.cache.face; }),
        number(
            row("sky-lights", "N", of_irradiance_cache,
                "Directions of the sky, with shadow maps, in each sample but the first", 0, 4096),
            [](O& o) -> Number { return &o.cache.sky_lights; }),
        number(row("spots", "N", of_irradiance_cache,
                   "VPLs in small places that lights light, as through a hole; 0: none", 0, 1024),
               [](O& o) -> Number { return &o.cache.spots; }),
        number(row("reflections", "N", of_irradiance_cache,
                   "Reflections of light before it reaches a record; 0: all that matter", 0, 1000),
               [](O& o) -> Number { return &o.cache.bounces; }),
        toggle(row("emission-by-hemicubes", "", of_irradiance_cache,
                   "Emissive surfaces light by hemicubes, in place of --area-samples"),
               [](O& o) -> bool& { return o.cache.emission; }),
    };
}

std::vector<OptionRow> of_all() {
    return {
        choice(
            row("math", "MATH", shown | of_bakes, "Math of the kernels; fast may reorder and round",
                0, 0, {"strict", "fast"}),
            [](O& o) -> Math& { return o.picture.build.math; },
            std::vector{Math::strict, Math::fast}),
        choice(
            row("storage", "STORAGE", shown,
                "Number format of planes between passes: full is float", 0, 0, {"full", "half"}),
            [](O& o) -> Storage& { return o.picture.build.storage; },
            std::vector{Storage::full, Storage::half}),
    };
}

}  // namespace

const std::vector<OptionRow>& option_table() {
    static const std::vector<OptionRow> table = [] {
        std::vector<OptionRow> out;
        for (const auto& rows :
             {of_pictures(), of_bake(), of_masks(), of_elements(), of_records(), of_all()})
            out.insert(out.end(), rows.begin(), rows.end());
        return out;
    }();
    return table;
}

const OptionRow& option(const std::string& name, unsigned methods) {
    for (const OptionRow& row : option_table())
        if (row.name == name && row.of(methods)) return row;
    throw Error("options: there is none of the name '" + name + "'");
}

void set_option(RendererOptions& options, const std::string& name, const std::string& value) {
    option(name).set(options, value);
}

std::string option_text(const RendererOptions& options, unsigned methods) {
    std::string out;
    for (const OptionRow& row : option_table())
        if (row.of(methods)) out += (out.empty() ? "" : " ") + row.name + "=" + row.get(options);
    return out;
}

}  // namespace clgi
