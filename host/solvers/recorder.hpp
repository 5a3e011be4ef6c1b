// Enqueues one pass after the other, remembers each one's event, and stops between two of them
// when it is told to.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/error.hpp>
#include <clgi/solvers/second_order.hpp>
#include <utility>

#include "opencl/error_text.hpp"

namespace clgi {

class SecondOrderSolver::Recorder {
public:
    // wait: what the first pass must wait for besides the frame still on the queue. end: the
    // event of the last pass on the queue, kept up to date pass by pass, so that a frame that
    // fails half-way leaves behind what the next one must wait for.
    Recorder(const WaitList& wait, WaitList& end, std::vector<PassEvent>& events,
             const Progress& progress)
        : before_(wait), end_(end), events_(events), progress_(progress) {
        events_.clear();
    }

    // enqueue(wait) puts one pass on the queue. On a queue in order too it waits by name for what
    // was there before, since only then must the failure of one end all that follow.
    template <typename Enqueue>
    void operator()(const char* name, std::size_t items, Enqueue&& enqueue) {
        if (cancelled_) return;
        WaitList wait = before_;
        wait.insert(wait.end(), end_.begin(), end_.end());
        cl::Event event = std::forward<Enqueue>(enqueue)(wait);
        before_.clear();
        end_.assign(1, event);
        events_.push_back({name, items, event});
    }

    // A pass on another queue, which the next one on this queue waits for.
    void beside(const char* name, std::size_t items, const cl::Event& event) {
        events_.push_back({name, items, event});
        before_.push_back(event);
        end_.push_back(event);
    }

    // Waits for what was enqueued and tells how much of the frame that is, [0,1].
    void report(double done) {
        if (!progress_ || cancelled_) return;
        try {
            if (!before_.empty()) cl::Event::waitForEvents(before_);
            if (!end_.empty()) cl::Event::waitForEvents(end_);
        } catch (const cl::Error& error) {
            throw DeviceError("second-order: the frame failed on the device: " +
                              error_text(error.err()));
        }
        cancelled_ = !progress_(done);
    }

    bool cancelled() const { return cancelled_; }
    cl::Event last() const { return end_.empty() ? cl::Event() : end_.front(); }

private:
    bool cancelled_ = false;
    WaitList before_;
    WaitList& end_;
    std::vector<PassEvent>& events_;
    const Progress& progress_;
};

}  // namespace clgi
