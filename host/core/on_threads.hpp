// One piece of work on several threads of the host.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <future>
#include <thread>
#include <vector>

namespace clgi {

// asked, or as many as there are cores where that is 0.
inline int thread_count(int asked) {
    if (asked > 0) return asked;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Calls work(thread) in each of them; throws what one of them threw.
inline void on_threads(int threads, const std::function<void(int)>& work) {
    std::vector<std::future<void>> others;
    for (int t = 1; t < threads; ++t) others.push_back(std::async(std::launch::async, work, t));
    work(0);
    for (std::future<void>& other : others) other.get();
}

}  // namespace clgi
