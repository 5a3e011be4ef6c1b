// A renderer with the scene that it draws, which follows what is shown as far as it can.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene_animator.hpp>
#include <memory>

#include "view/shown.hpp"

namespace clgi::view {

class Canvas {
public:
    // In the state of `shown`. moves: poses follow too. Throws what a Renderer does.
    Canvas(const Programs& programs, const cl::CommandQueue& queue, const Subject& subject,
           const Shown& shown, const RendererOptions& options, bool moves);

    // Whether follow() suffices to show this.
    bool can_follow(const Shown& shown) const;
    // May be repeated after it threw.
    void follow(const Shown& shown);
    // Whether the focus that it was made for is still about that of its picture.
    bool suits(const std::optional<Focus>& focus) const;

    // Whether what is prepared serves every camera.
    bool serves_cameras() const { return renderer_.options().method != Method::irradiance_cache; }
    // Whether pictures of other cameras are quick enough to be drawn while it moves.
    bool is_quick() const { return serves_cameras() && frame_ms_ < 60.0; }

    bool prepare(const Progress& progress);  // false: cancelled
    void draw();                             // from the viewpoint of what it follows
    void refine();
    Drawn drawn() const;  // the last picture; waits for it
    std::uint32_t samples() const { return renderer_.samples(); }
    double sampling_error() const { return renderer_.sampling_error(); }
    const RendererOptions& options() const { return renderer_.options(); }

private:
    void pose(const Shown& shown);
    void time_frame();

    Shown shown_;
    std::size_t clip_, camera_index_;
    double uploaded_turn_;  // degrees
    cl::CommandQueue queue_;
    Scene scene_;
    Camera camera_;      // without a viewpoint
    Camera drawn_from_;  // the last picture
    std::optional<Focus> focus_;
    DeviceScene device_scene_;
    std::unique_ptr<SceneAnimator> animator_;
    Renderer renderer_;
    double prepared_ms_ = 0.0, frame_ms_ = 0.0;
};

}  // namespace clgi::view
