// Calls of OpenCL that a test counts or makes fail. A program's own definition of a function comes
// before the loader's, so those of opencl_calls.cpp stand between clgi and the loader; the driver
// is behind it. They are part of the programs whose module is named in tests/CMakeLists.txt.
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <clgi/opencl.hpp>
#include <string>

namespace clgi::test {

struct Calls {
    std::atomic<int> buffers{0}, bytes{0}, kernels{0};
    std::atomic<int> blocking{0};  // finish, wait, flush, and reads and writes that block
    std::atomic<int> builds{0}, enqueued{0};

    // The call of this number from now on fails with `code`; 0: none.
    std::atomic<int> fail_buffer{0}, fail_enqueue{0}, code{CL_SUCCESS};
    std::atomic<int> fail_devices{CL_SUCCESS};
    std::string build_option;  // added to every build

    void clear() {
        buffers = bytes = kernels = blocking = builds = enqueued = 0;
        fail_buffer = fail_enqueue = 0;
        fail_devices = code = CL_SUCCESS;
        build_option.clear();
    }
};

extern Calls calls;

}  // namespace clgi::test
