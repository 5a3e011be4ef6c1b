// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kit/recorder.hpp>
#include <memory>

#include "core/opencl/error_text.hpp"

namespace clgi {
namespace {

using Bytes = std::vector<unsigned char>;

// What another queue waits for has to be on its way: nobody else may flush the queue that it is on.
void flush_other(const cl::Event& event, const cl::CommandQueue& queue) {
    const cl::CommandQueue of = event.getInfo<CL_EVENT_COMMAND_QUEUE>();
    if (of() && of() != queue()) of.flush();  // events of users have none
}

void CL_CALLBACK drop(cl_event, cl_int, void* bytes) { delete static_cast<Bytes*>(bytes); }

}  // namespace

Recorder::Recorder(const cl::CommandQueue& queue, std::string owner)
    : queue_(queue), owner_(std::move(owner)) {}

void Recorder::begin(const WaitList& wait, const Progress& progress) {
    forget_failed();
    for (const cl::Event& event : wait) flush_other(event, queue_);
    before_.insert(before_.end(), wait.begin(), wait.end());
    const auto ended = [](const cl::Event& event) {
        return event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() <= CL_COMPLETE;
    };
    running_.erase(std::remove_if(running_.begin(), running_.end(), ended), running_.end());
    progress_ = progress;
    cancelled_ = false;
    fills_.clear();
    events_.clear();
}

WaitList Recorder::waits() const {
    WaitList out = before_;
    out.insert(out.end(), end_.begin(), end_.end());
    return out;
}

void Recorder::passed(const cl::Event& event) {
    before_.clear();
    end_.assign(1, event);
    running_.push_back(event);  // PoCL 3.1 aborts where a command fails whose event nobody holds
}

void Recorder::write(const cl::Buffer& buffer, const void* data, std::size_t bytes,
                     std::size_t offset) {
    if (bytes == 0) return;
    // OpenCL reads the copy when the command runs; the end of the command frees it.
    const auto* begin = static_cast<const unsigned char*>(data);
    auto copy = std::make_unique<Bytes>(begin, begin + bytes);
    const WaitList wait = waits();
    cl::Event event;
    try {
        queue_.enqueueWriteBuffer(buffer, CL_FALSE, offset, bytes, copy->data(), &wait, &event);
        event.setCallback(CL_COMPLETE, drop, copy.get());
        copy.release();
    } catch (const cl::Error& error) {
        if (event()) event.wait();
        throw DeviceError(owner_ + ": a buffer cannot be written: " + error_text(error.err()));
    }
    passed(event);
}

void Recorder::fill(const cl::Buffer& buffer, std::uint32_t value) {
    const WaitList wait = waits();
    cl::Event event;
    try {
        const std::size_t bytes = buffer.getInfo<CL_MEM_SIZE>() / sizeof value * sizeof value;
        queue_.enqueueFillBuffer(buffer, value, 0, bytes, &wait, &event);
    } catch (const cl::Error& error) {
        throw DeviceError(owner_ + ": a buffer cannot be filled: " + error_text(error.err()));
    }
    passed(event);
}

void Recorder::fill_picture(const cl::Buffer& buffer, std::uint32_t value) {
    fill(buffer, value);
    fills_.push_back(end_.front());
}

void Recorder::wait() const {
    const WaitList pending = waits();
    try {
        if (!pending.empty()) cl::Event::waitForEvents(pending);
    } catch (const cl::Error& error) {
        throw DeviceError(owner_ + ": a pass failed on the device: " + error_text(error.err()));
    }
}

std::uint32_t Recorder::read_word(const cl::Buffer& buffer) const {
    std::uint32_t word = 0;
    const WaitList pending = waits();
    try {
        queue_.enqueueReadBuffer(buffer, CL_TRUE, 0, sizeof word, &word, &pending);
    } catch (const cl::Error& error) {
        throw DeviceError(owner_ + ": a word cannot be read: " + error_text(error.err()));
    }
    return word;
}

void Recorder::beside(const char* name, std::size_t items, const cl::Event& event) {
    flush_other(event, queue_);
    events_.push_back({name, items, event});
    before_.push_back(event);
}

void Recorder::report(double done) {
    if (!progress_ || cancelled_) return;
    wait();
    cancelled_ = !progress_(done);
}

void Recorder::forget_failed() {
    const auto failed = [](const cl::Event& event) {
        return event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() < 0;
    };
    for (WaitList* list : {&before_, &end_})
        list->erase(std::remove_if(list->begin(), list->end(), failed), list->end());
}

Interval Recorder::interval() const {
    WaitList all = fills_;
    // Other queues' clocks are their own; what they did lies between two of this queue's commands.
    for (const PassEvent& pass : events_)
        if (pass.event.getInfo<CL_EVENT_COMMAND_QUEUE>()() == queue_()) all.push_back(pass.event);
    return clgi::interval(all);
}

}  // namespace clgi
