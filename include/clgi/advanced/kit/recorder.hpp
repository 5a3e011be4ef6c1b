// Enqueues passes one after the other, keeps the event of each, and stops between two of them when
// it is cancelled. A solver has one recorder and begins a new sequence for every picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/interval.hpp>
#include <clgi/advanced/kit/progress.hpp>
#include <clgi/error.hpp>
#include <clgi/opencl.hpp>
#include <string>
#include <utility>
#include <vector>

namespace clgi {

struct PassEvent {
    std::string name;   // "image.gather"
    std::size_t items;  // that it worked on: triangles, pixels, VPLs
    cl::Event event;
};

// Works on the given queue, in order or not, and never finishes it. Used by one thread at a time.
class CLGI_API Recorder {
public:
    // owner begins the messages of errors: "second-order".
    Recorder(const cl::CommandQueue& queue, std::string owner);

    // A new sequence, which begins after `wait` and after what was enqueued before. The events of
    // the last sequence are forgotten. Queues of events in `wait` are flushed, so that what this
    // queue waits for is on its way.
    void begin(const WaitList& wait, const Progress& progress = nullptr);

    // enqueue(wait) puts one pass on the queue and returns its event. Every pass waits for the
    // event of the one before, on an in-order queue as well: only then does a failure end all that
    // follow.
    template <typename Enqueue>
    void operator()(const char* name, std::size_t items, Enqueue&& enqueue) {
        if (cancelled_) return;
        const cl::Event event = std::forward<Enqueue>(enqueue)(waits());
        passed(event);
        events_.push_back({name, items, event});
    }

    // Enqueues the write of a copy of these bytes to `offset` bytes behind the start of a buffer,
    // without waiting. Not a pass, and not part of interval().
    void write(const cl::Buffer& buffer, const void* data, std::size_t bytes,
               std::size_t offset = 0);

    // Fills a buffer with a value of 4 bytes; like write().
    void fill(const cl::Buffer& buffer, std::uint32_t value);

    // The same for a picture that consists of fills alone: interval() includes them.
    void fill_picture(const cl::Buffer& buffer, std::uint32_t value);

    // Waits for everything enqueued. Throws DeviceError if something failed.
    void wait() const;

    // Waits for the last command, and reads the first word of a buffer.
    std::uint32_t read_word(const cl::Buffer& buffer) const;

    // Adds a pass on another queue; the next one on this queue waits for it.
    void beside(const char* name, std::size_t items, const cl::Event& event);

    // With a progress function: waits for what was enqueued and reports the share done, [0,1].
    // Without one: does nothing.
    void report(double done);

    bool cancelled() const { return cancelled_; }
    cl::Event last() const { return end_.empty() ? cl::Event() : end_.front(); }

    // What the next command on this queue must wait for.
    WaitList waits() const;

    // Drops failed events, because waiting for them would fail again.
    void forget_failed();

    const cl::CommandQueue& queue() const { return queue_; }

    // The passes of the sequence, for profiling.
    const std::vector<PassEvent>& events() const { return events_; }

    // From the first command of the sequence on this queue to its end. Throws Error before it has
    // ended, and without profiling.
    Interval interval() const;

private:
    void passed(const cl::Event& event);

    cl::CommandQueue queue_;
    std::string owner_;
    Progress progress_;
    bool cancelled_ = false;
    WaitList before_;   // what the next command must wait for besides the last one
    WaitList end_;      // the last command; kept up to date, so that a sequence that fails half-way
                        // leaves behind what the next one must wait for
    WaitList fills_;    // of a picture made of fills
    WaitList running_;  // commands that had not ended by the last begin(), and those since
    std::vector<PassEvent> events_;
};

}  // namespace clgi
