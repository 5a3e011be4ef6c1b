// One piece of work on several threads of the host.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
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

// Calls work(i) for i in 0 to count - 1, on all cores; each takes `at_once` of them at a time.
template <typename Work>
void for_each_of(std::size_t count, std::size_t at_once, const Work& work) {
    const std::size_t shares = (count + at_once - 1) / at_once;
    std::atomic<std::size_t> next{0};
    on_threads(static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(thread_count(0)),
                                                      std::max<std::size_t>(shares, 1))),
               [&](int) {
                   for (std::size_t share = next++; share < shares; share = next++)
                       for (std::size_t i = share * at_once;
                            i < std::min((share + 1) * at_once, count); ++i)
                           work(i);
               });
}

}  // namespace clgi
