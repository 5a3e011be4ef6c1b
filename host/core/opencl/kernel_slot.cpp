// SPDX-License-Identifier: MIT
#include "core/opencl/kernel_slot.hpp"

#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <sstream>
#include <utility>

#include "core/opencl/embedded.hpp"
#include "core/opencl/error_text.hpp"

namespace clgi {
namespace {

// What the compiler said; empty where there is no program, or the device is lost.
std::string build_log(const cl::Program& program, const cl::Device& device) {
    if (!program()) return "";
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    } catch (const cl::Error&) {
        return "";
    }
}

}  // namespace

std::string options_for(const std::string& source, const std::string& options) {
    std::string out;
    std::istringstream words(options);
    for (std::string word; words >> word;) {
        const bool defines = word.compare(0, 2, "-D") == 0;
        if (defines && source.find(word.substr(2, word.find('=') - 2)) == std::string::npos)
            continue;
        out += (out.empty() ? "" : " ") + word;
    }
    return out;
}

KernelSlot::KernelSlot(const cl::Context& context, const cl::Device& device, std::string file,
                       std::string function, std::shared_ptr<KernelUnit> unit, std::string options,
                       std::shared_ptr<const BinaryCache> cache)
    : context_(context),
      device_(device),
      file_(std::move(file)),
      function_(std::move(function)),
      options_(std::move(options)),
      unit_(std::move(unit)),
      cache_(std::move(cache)) {}

cl::Program KernelSlot::compiled(const std::vector<std::string>& files) const {
    const std::string source = kernels_source(files), options = options_for(source, options_);
    if (auto kept = cache_->find(context_, device_, source, options)) return *kept;
    cl::Program program(context_, source);
    try {
        program.build(device_, options.c_str());
    } catch (const cl::Error& error) {
        throw DeviceError("program: " + files.front() + ".cl does not build on " +
                          describe(device_) + ": " + error_text(error.err()) + "\n" +
                          build_log(program, device_));
    }
    cache_->keep(program, device_, source, options);
    return program;
}

cl::Program KernelSlot::own_program() const {
    if (!unit_) return compiled({file_});
    const std::lock_guard lock(unit_->mutex);
    try {
        if (!unit_->program()) unit_->program = compiled(unit_->files);
        return unit_->program;
    } catch (const DeviceError&) {  // of another of its kernels, perhaps
        return compiled({file_});
    }
}

std::string KernelSlot::family() const {
    return unit_ ? unit_->files.front() : file_.substr(0, file_.find('/'));
}

void KernelSlot::take(const cl::Program& program) {
    std::call_once(once_, [&] {
        kernel_ = cl::Kernel(program() ? program : own_program(), function_.c_str());
        most_items_ = kernel_.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_);
        built_ = true;
    });
}

void KernelSlot::build() {
    try {
        take(cl::Program());
    } catch (const cl::Error& error) {
        throw DeviceError("program: " + file_ + ".cl gives no kernel on " + describe(device_) +
                          ": " + error_text(error.err()));
    }
}

void KernelSlot::build_together(const std::vector<std::shared_ptr<KernelSlot>>& slots) {
    std::vector<std::string> files;
    for (const auto& slot : slots) files.push_back(slot->file_);
    cl::Program program;
    try {
        if (files.size() > 1 && !slots.front()->unit_) program = slots.front()->compiled(files);
        for (const auto& slot : slots) slot->take(program);
    } catch (const std::exception&) {
        for (const auto& slot : slots) slot->build();
    }
}

std::size_t KernelSlot::most_items() {
    build();
    return most_items_;
}

}  // namespace clgi
