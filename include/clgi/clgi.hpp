// All headers of clgi::clgi. Those of clgi::io, clgi::gl and clgi::reference are separate.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/adjacency.hpp>
#include <clgi/atlas_layout.hpp>
#include <clgi/atlas_light.hpp>
#include <clgi/device.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/emitters.hpp>
#include <clgi/error.hpp>
#include <clgi/interval.hpp>
#include <clgi/kernel_source.hpp>
#include <clgi/kit/buffer_table.hpp>
#include <clgi/kit/draw.hpp>
#include <clgi/kit/emitters.hpp>
#include <clgi/kit/recorder.hpp>
#include <clgi/passes/atlas.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/image.hpp>
#include <clgi/passes/import.hpp>
#include <clgi/passes/lights.hpp>
#include <clgi/passes/parallel.hpp>
#include <clgi/passes/scene.hpp>
#include <clgi/passes/vpl.hpp>
#include <clgi/patches.hpp>
#include <clgi/procedural.hpp>
#include <clgi/programs.hpp>
#include <clgi/scene.hpp>
#include <clgi/scene_animator.hpp>
#include <clgi/scene_mover.hpp>
#include <clgi/slice.hpp>
#include <clgi/solvers/light_atlas.hpp>
#include <clgi/solvers/light_atlas_view.hpp>
#include <clgi/solvers/second_order.hpp>
#include <clgi/vpl_layout.hpp>
