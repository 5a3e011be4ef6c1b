// The program built without meshoptimizer: bench kautz1 and kautz2 say so.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>

#include "program/bench.hpp"

namespace clgi::program {

void run_kautz(const BenchFlags& flags, const Session&) {
    throw Error("bench: " + flags.table + " needs a program built with meshoptimizer (CLGI_MESH)");
}

}  // namespace clgi::program
