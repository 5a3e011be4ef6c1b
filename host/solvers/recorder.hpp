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

    // enqueue(wait) puts one pass on the queue. On a queue in order nothing on it need be waited
    // for.
    template <typename Enqueue>
    void operator()(const char* name, std::size_t items, Enqueue&& enqueue) {
        WaitList waits = in_order_ ? WaitList() : last_;
        waits.insert(waits.end(), elsewhere_.begin(), elsewhere_.end());
        elsewhere_.clear();
        cl::Event event = std::forward<Enqueue>(enqueue)(waits);
        last_.assign(1, event);
        events_.push_back({name, items, event});
    }

    // Work on other queues, or of other libraries, that the next pass must wait for.
    void wait_for(const WaitList& elsewhere) { elsewhere_ = elsewhere; }

    const WaitList& wait() const { return last_; }
    cl::Event last() const { return last_.empty() ? cl::Event() : last_.front(); }

private:
    bool in_order_;
    std::vector<PassEvent>& events_;
    WaitList elsewhere_;
    WaitList last_;
};

}  // namespace clgi
