// The environment of a scene as coefficients on the device, kept up to date.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/transfer.hpp>
#include <vector>

namespace clgi {

// A solver adds the buffers to its table, writes what does not change once they are allocated, and
// projects when the light has changed. The scene must outlive this object. A scene without
// environment has a black one.
class CLGI_API EnvironmentLight {
public:
    // bands: 1 to SH_MOST_BANDS. directional: the scene's directional lights are part of it.
    EnvironmentLight(const DeviceScene& scene, int bands, bool directional = false);

    void add_to(BufferTable& table);
    void write(Recorder& record) const;

    // Reads the scene's directional lights again.
    void update();

    // About +Y, radians, beside the environment's own.
    void turn(double angle) { turned_ = angle; }

    // Of what was projected last.
    double projected_turn() const { return projected_turn_; }

    // The whole projection; or, with the picture projected before, what light, turn and update
    // have changed. A picture whose passes failed or were left out is projected again.
    void project(Recorder& record, const TransferPasses& passes);

    const cl::Buffer& light() const { return buffers_.light; }  // [terms] float4, exposed cd/m^2 sr
    const cl::Buffer& counter() const {
        return buffers_.non_finite;
    }  // [1] uint: floats of the
       // picture read as 0
private:
    bool is_projected() const;

    const DeviceScene* scene_;
    EnvironmentProjection projection_;
    bool directional_;
    cl::Event projected_;  // the end of the passes that read the picture
    double turned_ = 0.0, projected_turn_ = 0.0;
    std::vector<DirectionalLight> lights_;
    std::size_t capacity_ = 0;  // directional lights that there are buffers for
    ProjectionBuffers buffers_;
};

}  // namespace clgi
