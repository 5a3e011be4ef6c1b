// SPDX-License-Identifier: MIT
#include "core/opencl/program.hpp"

#include <algorithm>
#include <clgi/advanced/kernel_source.hpp>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <cstdlib>
#include <future>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "core/opencl/embedded.hpp"
#include "core/opencl/kernel_slot.hpp"

namespace clgi {
namespace {

int width_of(const cl::Device& device, const BuildOptions& options) {
    const int width = options.packet_width > 0     ? options.packet_width
                      : in_groups(device, options) ? 1
                                                   : packet_width(device);
    if (width != 1 && width != 4 && width != 8 && width != 16)
        throw Error("program: packet_width is " + std::to_string(width) + ", 1, 4, 8 or 16 needed");
    return width;
}

// oclgrind's compiler breaks when two threads call it, though OpenCL allows it.
bool builds_from_threads(const cl::Device& device) {
    return cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>() !=
           "Oclgrind";
}

}  // namespace

std::string compiler_options(const cl::Device& device, const BuildOptions& options) {
    // -w: drivers print how many warnings there were, and not which.
    std::string text = "-cl-std=CL1.2 -w -DCLGI_WIDTH=" + std::to_string(width_of(device, options));
    if (uses_atomics64(device, options)) text += " -DCLGI_ATOMIC64";
    if (!options.textures) text += " -DCLGI_NO_TEXTURES";
    if (options.storage == Storage::half) text += " -DCLGI_HALF";
    if (options.math == Math::fast) {
        text += " -cl-fast-relaxed-math";
    } else if (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) {
        text += " -cl-fp32-correctly-rounded-divide-sqrt";
    }
    return text;
}

bool uses_atomics64(const cl::Device& device, const BuildOptions& options) {
    return options.atomics64 && device.getInfo<CL_DEVICE_EXTENSIONS>().find(
                                    "cl_khr_int64_extended_atomics") != std::string::npos;
}

bool in_groups(const cl::Device& device, const BuildOptions& options) {
    if (options.form != Form::automatic) return options.form == Form::groups;
    const char* variable = std::getenv("CLGI_FORM");
    const std::string form = variable ? variable : "";
    if (form == "groups" || form == "packets") return form == "groups";
    if (!form.empty()) throw Error("CLGI_FORM is \"" + form + "\", packets or groups needed");
    return !(device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU);
}

PassKernel in_small_groups(PassKernel pass, const cl::Device& device, const BuildOptions& options) {
    constexpr std::size_t few = 4;
    if (options.local_size == 0 && !in_groups(device, options)) pass.local_size = few;
    return pass;
}

PassKernel group_form(const Programs& programs, const std::string& folder, const std::string& pass,
                      const BuildOptions& options, const std::string& defines, std::size_t lanes,
                      std::size_t most) {
    PassKernel out = programs.kernel(folder, pass + "_group", options, defines);
    out.name = folder + "." + pass;
    out.local_size = std::min(options.local_size > 0 ? options.local_size : lanes, most);
    return out;
}

std::size_t items_each(const PassKernel& pass, bool grouped) {
    return grouped ? group_size(pass) : 1;
}

bool builds_in_turn(const cl::Device& device) {
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    return platform.getInfo<CL_PLATFORM_NAME>() == "Portable Computing Language";
}

struct Programs::Store {
    std::mutex mutex;
    std::map<std::string, std::string> sources;                // by file
    std::map<std::string, std::shared_ptr<KernelSlot>> slots;  // by file and options
    std::map<std::string, std::shared_ptr<KernelUnit>> units;  // by room, first pass and options
    const std::shared_ptr<BinaryCache> cache = std::make_shared<BinaryCache>();
};

Programs::Programs(const cl::Context& context, const cl::Device& device)
    : context_(context), device_(device), store_(std::make_shared<Store>()) {}

PassKernel Programs::kernel(const std::string& room, const std::string& pass,
                            const BuildOptions& options, const std::string& defines,
                            const std::vector<std::string>& together) const {
    const std::string file = room + "/" + pass;
    PassKernel out;
    out.name = room + "." + pass;
    out.local_size = options.local_size > 0 ? options.local_size : 64;
    out.packet_width = width_of(device_, options);
    out.storage = options.storage;
    out.parallel = options.parallel && builds_from_threads(device_);
    const std::lock_guard lock(store_->mutex);
    std::string& source = store_->sources[file];
    if (source.empty()) source = kernel_source(file);
    const std::string asked = compiler_options(device_, options) + " " + defines;
    std::shared_ptr<KernelSlot>& slot = store_->slots[file + " " + options_for(source, asked)];
    if (!slot) {
        std::shared_ptr<KernelUnit> unit;
        if (!together.empty() && builds_in_turn(device_)) {
            std::shared_ptr<KernelUnit>& held = store_->units[room + together.front() + asked];
            if (!held) held = std::make_shared<KernelUnit>(room, together);
            unit = held;
        }
        slot = std::make_shared<KernelSlot>(context_, device_, file, room + "_" + pass, unit, asked,
                                            store_->cache);
    }
    out.slot = slot;
    return out;
}

void Programs::keep_binaries(const std::filesystem::path& folder) {
    store_->cache->set_folder(folder);
}

std::size_t Programs::built() const {
    const std::lock_guard lock(store_->mutex);
    return static_cast<std::size_t>(
        std::count_if(store_->slots.begin(), store_->slots.end(),
                      [](const auto& entry) { return entry.second->built(); }));
}

std::vector<std::string> Programs::built_kernels() const {
    const std::lock_guard lock(store_->mutex);
    std::vector<std::string> out;
    for (const auto& [name, slot] : store_->slots)
        if (slot->built()) out.push_back(name);
    return out;
}

void build(const std::vector<PassKernel>& kernels) {
    struct Program {
        std::map<std::string, std::shared_ptr<KernelSlot>> slots;  // by file
        bool parallel = true;
    };
    // By context, device, unit or folder, and options, and by a number: what several Programs have
    // of the same kernel goes into programs of its own.
    std::map<std::tuple<cl_context, cl_device_id, std::string, int>, Program> programs;
    for (const PassKernel& kernel : kernels) {
        if (!kernel.slot || kernel.slot->built()) continue;
        const KernelSlot& slot = *kernel.slot;
        const std::string alike = slot.family() + slot.options();
        for (int number = 0;; ++number) {
            Program& program = programs[{slot.context()(), slot.device()(), alike, number}];
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
