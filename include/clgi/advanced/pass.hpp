// What all passes have in common: build options, and one kernel that is ready to be enqueued.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/opencl.hpp>
#include <cstddef>
#include <memory>
#include <string>

namespace clgi {

enum class Math { strict, fast };

// How planes of directions, colours and irradiance are stored between passes: as float, or as half,
// which moves half the bytes and rounds to 11 bits. Positions, depth and the final radiance are
// float in both. Layout: clgi/shared/planes.h.
enum class Storage { full, half };

// How the work of a kernel is laid out where it has both forms. packets: a work-item alone draws a
// view or a tile, with vectors; for CPUs. groups: a group of work-items does so together; for GPUs.
// automatic: what the environment variable CLGI_FORM says, else by the kind of device. Both give
// the same bits, but for hemicubes of finely modelled scenes by an irradiance cache
// (GBufferPasses::prefers_trace_views), which packets alone draw by rays.
enum class Form { automatic, packets, groups };

// How kernels are built. Results do not depend on packet_width, local_size or, but for the above,
// form. Passes that share planes must have the same storage.
struct BuildOptions {
    Math math = Math::strict;
    Storage storage = Storage::full;
    int packet_width = 0;  // lanes of a packet: 1, 4, 8 or 16; 0: best for device and form
    Form form = Form::automatic;
    std::size_t local_size = 0;  // work-items in a group, or as many as a kernel and the device
                                 // allow; 0: what suits each kernel
    bool atomics64 = true;       // use 64-bit atomics where the device has them
    bool parallel = true;        // compile several kernels at a time, if the driver can
    bool textures = true;        // false compiles faster, for scenes without textures and
                                 // alpha alone (DeviceScene::needs_textures)
};

inline bool operator==(const BuildOptions& a, const BuildOptions& b) {
    return a.math == b.math && a.storage == b.storage && a.packet_width == b.packet_width &&
           a.form == b.form && a.local_size == b.local_size && a.atomics64 == b.atomics64 &&
           a.parallel == b.parallel && a.textures == b.textures;
}
inline bool operator!=(const BuildOptions& a, const BuildOptions& b) { return !(a == b); }

// The items that a pass works on. A number alone means all of that many items.
struct Range {
    Range(std::size_t all) : count(all), whole(true) {}
    Range(std::size_t first_item, std::size_t item_count) : first(first_item), count(item_count) {}
    std::size_t first = 0;
    std::size_t count = 0;
    bool whole = false;
};

class KernelSlot;  // host/core/opencl/kernel_slot.hpp

// One kernel of a room. It is built when it is first enqueued; copies share it and may be used by
// several threads at a time.
struct PassKernel {
    std::string name;             // "gbuffer.raster"
    std::size_t local_size = 64;  // work-items of a group, or what the kernel allows at most
    int packet_width = 1;
    Storage storage = Storage::full;
    bool parallel = true;  // may be built beside others
    std::shared_ptr<KernelSlot> slot;
};

}  // namespace clgi
