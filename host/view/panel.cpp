// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/options.hpp>
#include <cmath>

#include "view/controls.hpp"

namespace clgi::view {
namespace {

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str()); }

void choose_method_of_list(Shown& shown) {
    const char* now = shown.method ? name_of(*shown.method) : "auto";
    if (!ImGui::BeginCombo("method", now)) return;
    for (int m = -1; m <= static_cast<int>(Method::irradiance_cache); ++m) {
        std::optional<Method> method;
        if (m >= 0) method = static_cast<Method>(m);
        if (!ImGui::Selectable(method ? name_of(*method) : "auto", shown.method == method))
            continue;
        shown.method = method;
        shown.by_hand.reset();
        ++shown.set;
    }
    ImGui::EndCombo();
}

void tell(const Drawn& drawn, double frames_a_second) {
    const char* method = name_of(drawn.options.method);
    if (drawn.preview || drawn.options.samples < 2)
        text(fmt::format("{}{}: {:.0f} ms, {:.0f} pictures a second", method,
                         drawn.preview ? ", coarse" : "", drawn.frame_ms, frames_a_second));
    else
        text(fmt::format("{}: {} samples, the first in {:.2f} s", method, drawn.options.samples,
                         1e-3 * (drawn.prepared_ms + drawn.frame_ms)));
    if (drawn.check)
        text(fmt::format("measured error {:.1f} % ({:.1f} to {:.1f}), energy {:.3f}",
                         100.0 * drawn.check->error.value, 100.0 * drawn.check->error.low,
                         100.0 * drawn.check->error.high, drawn.check->energy.value));
    for (const std::string& warning : drawn.warnings) ImGui::TextWrapped("%s", warning.c_str());
}

// One row of the table of options; true if it was changed.
bool edit(const OptionRow& row, RendererOptions& options) {
    std::string value = row.get(options);
    bool changed = false;
    if (row.kind == OptionRow::Kind::toggle) {
        bool on = value == "true";
        changed = ImGui::Checkbox(row.name.c_str(), &on);
        value = on ? "true" : "false";
    } else if (!row.choices.empty()) {
        if (ImGui::BeginCombo(row.name.c_str(), value.c_str())) {
            for (const std::string& choice : row.choices)
                if (ImGui::Selectable(choice.c_str(), choice == value)) {
                    value = choice;
                    changed = true;
                }
            ImGui::EndCombo();
        }
    } else {
        char typed[32] = {};
        value.copy(typed, sizeof typed - 1);
        changed = ImGui::InputText(row.name.c_str(), typed, sizeof typed,
                                   ImGuiInputTextFlags_EnterReturnsTrue);
        value = typed;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", row.help.c_str());
    if (!changed) return false;
    try {
        row.set(options, value);
    } catch (const Error&) {
        return false;  // it stays as it was
    }
    return true;
}

// Rows that a picture of a window has no use for.
bool fixed(const OptionRow& row) {
    for (const char* name : {"samples", "math", "storage", "rings", "poses", "least-change"})
        if (row.name == name) return true;
    return false;
}

void edit_settings(const Drawn& drawn, Shown& shown) {
    if (!ImGui::CollapsingHeader("settings")) return;
    RendererOptions options = shown.by_hand.value_or(drawn.options);
    bool changed = false;
    for (const OptionRow& row : option_table())
        if (row.of(methods_of(options.method)) && !fixed(row)) changed |= edit(row, options);
    if (changed) {
        options.samples = 1;
        shown.method = options.method;
        shown.by_hand = options;
        ++shown.set;
    }
    if (shown.by_hand && ImGui::Button("by a plan")) {
        shown.by_hand.reset();
        ++shown.set;
    }
}

void edit_lights(const std::vector<Light>& lights, Shown& shown, std::size_t& chosen) {
    constexpr auto clamped = ImGuiSliderFlags_AlwaysClamp;
    constexpr float far = 1e6f;  // metres
    if (lights.empty() || !ImGui::CollapsingHeader("lights")) return;
    const auto name = [&](std::size_t i) { return fmt::format("{} {}", i, lights[i].name); };
    if (ImGui::BeginCombo("light", name(chosen).c_str())) {
        for (std::size_t i = 0; i < lights.size(); ++i)
            if (ImGui::Selectable(name(i).c_str(), i == chosen)) chosen = i;
        ImGui::EndCombo();
    }
    const auto edited = shown.lights.find(chosen);
    Light light = edited == shown.lights.end() ? lights[chosen] : edited->second;
    glm::vec3 place(light.position);
    float stops = 0.0f;  // by which it gets brighter
    bool changed = false;
    if (light.kind != Light::Kind::directional &&
        ImGui::DragFloat3("position", &place.x, 0.01f, -far, far, "%.3f", clamped)) {
        light.position = glm::dvec3(place);
        changed = true;
    }
    if (light.kind != Light::Kind::point &&
        ImGui::DragFloat3("direction", &light.direction.x, 0.01f, -1.0f, 1.0f, "%.3f", clamped)) {
        const float length = glm::length(light.direction);
        changed = length > 0.0f;
        if (changed) light.direction /= length;
    }
    const float most = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
    if (ImGui::DragFloat("brighter, stops", &stops, 0.01f, -8.0f, 8.0f, "%.2f", clamped) &&
        most < 1e30f) {
        light.intensity *= std::exp2(stops);
        changed = true;
    }
    if (!changed) return;
    shown.lights[chosen] = light;
    ++shown.lit;
}

void edit_sky_and_pose(const Subject& subject, Shown& shown, Controls& controls) {
    if (subject.scene.environment) {
        auto turn = static_cast<float>(shown.turn);
        if (ImGui::SliderFloat("sky, degrees", &turn, -180.0f, 180.0f, "%.1f",
                               ImGuiSliderFlags_AlwaysClamp)) {
            shown.turn = double{turn};
            ++shown.lit;
        }
    }
    if (!subject.scene.animation) return;
    ImGui::Checkbox("play", &controls.playing);
    auto seconds = static_cast<float>(shown.seconds.value_or(0.0));
    if (ImGui::DragFloat("seconds", &seconds, 0.01f, 0.0f, 1e6f, "%.2f",
                         ImGuiSliderFlags_AlwaysClamp)) {
        shown.seconds = double{seconds};
        ++shown.posed;
    }
}

}  // namespace

void draw_panel(const Subject& subject, const Drawn& drawn, const Painter::Status& status,
                double frames_a_second, Shown& shown, Controls& controls) {
    if (!controls.panel) return;
    ImGui::SetNextWindowPos(ImVec2(8, 8), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowBgAlpha(0.7f);
    ImGui::Begin("clgi", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushItemWidth(170.0f);
    choose_method_of_list(shown);
    tell(drawn, frames_a_second);
    if (!status.doing.empty()) text(status.doing);
    if (!status.trouble.empty()) ImGui::TextWrapped("%s", status.trouble.c_str());
    if (!drawn.preview || shown.by_hand) edit_settings(drawn, shown);
    edit_lights(drawn.lights, shown, controls.light);
    edit_sky_and_pose(subject, shown, controls);
    ImGui::Checkbox("exposure from the picture", &controls.automatic);
    if (!controls.automatic)
        ImGui::SliderFloat("stops", &controls.stops, -16.0f, 16.0f, "%.1f",
                           ImGuiSliderFlags_AlwaysClamp);
    controls.save |= ImGui::Button("save picture (P)");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s",
                          "drag: orbit, right button: look around, wheel: nearer\n"
                          "W A S D Q E: walk; Ctrl drag: light, Shift drag: sky\n"
                          "0 to 6: method; Space: play; H: this panel; Esc: leave");
    ImGui::PopItemWidth();
    ImGui::End();
}

}  // namespace clgi::view
