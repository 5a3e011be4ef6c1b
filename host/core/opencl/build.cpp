// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/programs.hpp>
#include <future>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/opencl/kernel_slot.hpp"
#include "core/opencl/program.hpp"

namespace clgi {
namespace {

thread_local BuildTogether* collecting = nullptr;

// Kernels that are one program: those of a folder, whose programs are then built at the same time.
// PoCL builds one program after the other, and reads the built-in functions for each.
std::string family(const KernelSlot& slot) {
    const cl::Platform platform(slot.device().getInfo<CL_DEVICE_PLATFORM>());
    if (platform.getInfo<CL_PLATFORM_NAME>() == "Portable Computing Language") return "";
    return slot.file().substr(0, slot.file().find('/'));
}

void build_now(const std::vector<PassKernel>& kernels) {
    struct Program {
        std::map<std::string, std::shared_ptr<KernelSlot>> slots;  // by file
        bool parallel = true;
    };
    // By context, device, family and options, and by a number: what several Programs have of the
    // same kernel goes into programs of its own.
    std::map<std::tuple<cl_context, cl_device_id, std::string, int>, Program> programs;
    for (const PassKernel& kernel : kernels) {
        if (!kernel.slot || kernel.slot->built()) continue;
        const KernelSlot& slot = *kernel.slot;
        for (int number = 0;; ++number) {
            Program& program = programs[{slot.context()(), slot.device()(),
                                         family(slot) + slot.options(), number}];
            std::shared_ptr<KernelSlot>& held = program.slots[slot.file()];
            if (held && held != kernel.slot) continue;
            held = kernel.slot;
            program.parallel = program.parallel && kernel.parallel;
            break;
        }
    }
    std::vector<std::future<void>> builds;
    for (const auto& [key, program] : programs) {
        std::vector<std::shared_ptr<KernelSlot>> slots;
        for (const auto& [file, slot] : program.slots) slots.push_back(slot);
        builds.push_back(
            std::async(program.parallel ? std::launch::async : std::launch::deferred,
                       [slots = std::move(slots)] { KernelSlot::build_together(slots); }));
    }
    for (auto& build : builds) build.wait();
    for (auto& build : builds) build.get();
}

}  // namespace

BuildTogether::BuildTogether() : outer_(std::exchange(collecting, this)) {}

BuildTogether::~BuildTogether() { collecting = outer_; }

void BuildTogether::finish() {
    BuildTogether* const before = std::exchange(collecting, outer_);
    build(std::exchange(kernels_, {}));
    collecting = before;
}

void build(const std::vector<PassKernel>& kernels) {
    if (!collecting) return build_now(kernels);
    std::vector<PassKernel>& noted = collecting->kernels_;
    noted.insert(noted.end(), kernels.begin(), kernels.end());
}

void build_named(const std::vector<PassKernel>& kernels,
                 std::initializer_list<const char*> passes) {
    std::vector<PassKernel> wanted;
    for (const char* pass : passes) {
        const auto found = std::find_if(kernels.begin(), kernels.end(), [&](const PassKernel& k) {
            return k.name.substr(k.name.find('.') + 1) == pass;
        });
        if (found == kernels.end())
            throw Error(std::string("build: there is no pass ") + pass + " here");
        wanted.push_back(*found);
    }
    build(wanted);
}

}  // namespace clgi
