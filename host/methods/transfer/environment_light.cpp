// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/environment_light.hpp>
#include <clgi/advanced/sh.hpp>

namespace clgi {
namespace {

EnvironmentProjection projection_of(const DeviceScene& scene, int bands) {
    const auto& sky = scene.environment();
    EnvironmentProjection out(sky ? sky->width : 1, sky ? sky->height : 1, bands);
    const glm::dvec3 factor = sky ? glm::dvec3(sky->factor) : glm::dvec3(0.0);
    out.params.factor = glm::vec4(factor / scene.frame().exposure, 0.0f);
    return out;
}

}  // namespace

EnvironmentLight::EnvironmentLight(const DeviceScene& scene, int bands, bool directional)
    : scene_(&scene), projection_(projection_of(scene, bands)), directional_(directional) {
    if (directional_) lights_ = directional_lights(scene);
    // Any light may become a directional one (DeviceScene::set_light).
    if (directional_) capacity_ = scene.lights().size();
    projection_.params.light_count = static_cast<std::uint32_t>(lights_.size());
    if (scene.environment()) buffers_.texels = scene.environment_texels();
}

void EnvironmentLight::add_to(BufferTable& table) {
    const char* picture = "the environment's picture";
    const auto add = [&](cl::Buffer& buffer, const char* name, std::size_t floats) {
        table.add(buffer, name, picture, floats * sizeof(float));
    };
    add(buffers_.row_weights, "weights of rows", projection_.row_weights.size());
    add(buffers_.column_weights, "weights of columns", projection_.column_weights.size());
    add(buffers_.waves, "waves", projection_.waves.size());
    add(buffers_.rotation, "the environment's rotation",
        static_cast<std::size_t>(sh::rotation_block(projection_.bands)));
    table.add(buffers_.sums, "sums of the environment", picture, projection_.sums_bytes());
    table.add(buffers_.leaves, "sums of the environment", picture, projection_.leaves_bytes());
    if (capacity_ > 0)
        table.add(buffers_.lights, "directional lights", "the number of directional lights",
                  capacity_ * sizeof(DirectionalLight));
    add(buffers_.light, "the environment's light",
        4 * static_cast<std::size_t>(sh::terms(projection_.bands)));
    table.add_word(buffers_.non_finite, "counters", 0);
    if (!scene_->environment()) table.add_word(buffers_.texels, "a black environment", 0);
}

void EnvironmentLight::write(Recorder& record) const {
    const auto put = [&](const cl::Buffer& buffer, const std::vector<float>& values) {
        record.write(buffer, values.data(), values.size() * sizeof(float));
    };
    put(buffers_.row_weights, projection_.row_weights);
    put(buffers_.column_weights, projection_.column_weights);
    put(buffers_.waves, projection_.waves);
}

void EnvironmentLight::update() {
    if (!directional_) return;
    lights_ = directional_lights(*scene_);
    projection_.params.light_count = static_cast<std::uint32_t>(lights_.size());
}

// A failure before them, which comes long after the call, ends the passes that were enqueued.
bool EnvironmentLight::is_projected() const {
    return projected_() && projected_.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() >= CL_COMPLETE;
}

void EnvironmentLight::project(Recorder& record, const TransferPasses& passes) {
    const double own = scene_->environment() ? double{scene_->environment()->rotation} : 0.0;
    const std::vector<float> rotation = environment_rotation(own + turned_, projection_.bands);
    projected_turn_ = turned_;
    record.write(buffers_.rotation, rotation.data(), rotation.size() * sizeof(float));
    if (!lights_.empty())
        record.write(buffers_.lights, lights_.data(), lights_.size() * sizeof(lights_[0]));
    const cl::CommandQueue& queue = record.queue();
    const std::size_t texels = std::size_t{projection_.params.width} * projection_.params.height;
    if (!is_projected()) {
        projected_ = cl::Event();
        record.fill(buffers_.non_finite, 0);  // rows may have run before columns failed
        record("transfer.project_rows", texels, [&](const WaitList& wait) {
            return passes.project_rows(queue, projection_.params, buffers_, wait);
        });
        record("transfer.project_columns", projection_.params.width, [&](const WaitList& wait) {
            return passes.project_columns(queue, projection_.params, buffers_, wait);
        });
        if (!record.cancelled()) projected_ = record.last();
    }
    record("transfer.project_environment", static_cast<std::size_t>(sh::terms(projection_.bands)),
           [&](const WaitList& wait) {
               return passes.project_environment(queue, projection_.params, buffers_, wait);
           });
}

}  // namespace clgi
