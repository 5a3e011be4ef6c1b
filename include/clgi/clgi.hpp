// All headers of clgi::clgi. Those of clgi::io, clgi::gl and clgi::reference are separate.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/emitters.hpp>
#include <clgi/error.hpp>
#include <clgi/interval.hpp>
#include <clgi/kernel_source.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/image.hpp>
#include <clgi/passes/import.hpp>
#include <clgi/passes/lights.hpp>
#include <clgi/procedural.hpp>
#include <clgi/scene.hpp>
#include <clgi/slice.hpp>
#include <clgi/solvers/second_order.hpp>
