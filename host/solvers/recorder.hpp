// Enqueues one pass after the other and remembers each one's event.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>
#include <utility>

namespace clgi {

class SecondOrderSolver::Recorder {
public:
    // before: what the first pass must wait for, a frame still on the queue; may be empty.
    Recorder(const cl::CommandQueue& queue, const WaitList& before, std::vector<PassEvent>& events)
        : in_order_(
              !(queue.getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE)),
          events_(events),
          last_(before) {
        events_.clear();
    }

    // enqueue(wait) puts one pass on the queue. On a queue in order nothing need be waited for.
    template <typename Enqueue>
    void operator()(const char* name, std::size_t items, Enqueue&& enqueue) {
        cl::Event event = std::forward<Enqueue>(enqueue)(in_order_ ? none_ : last_);
        last_.assign(1, event);
        events_.push_back({name, items, event});
    }

    const WaitList& wait() const { return last_; }
    cl::Event last() const { return last_.empty() ? cl::Event() : last_.front(); }

private:
    bool in_order_;
    std::vector<PassEvent>& events_;
    WaitList none_;
    WaitList last_;
};

}  // namespace clgi
