#!/usr/bin/env bash
# Builds the fuzz targets and runs each for a while (docs/stability.md).
#
#   tests/fuzz/run.sh [seconds]     300 by default
#
# New inputs that reach new code are kept in build-fuzz/corpus; what fails is written to build-fuzz
# and ends the run. Needs clang with libFuzzer.
# SPDX-License-Identifier: MIT
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
seconds=${1:-300}
cd "$root"
cmake --preset fuzz
cmake --build --preset fuzz --target scene_fuzz options_fuzz

cd build-fuzz
export UBSAN_OPTIONS=print_stacktrace=1
run() {  # target, longest input, options of libFuzzer
    mkdir -p "corpus/$1"
    "tests/fuzz/$1_fuzz" -max_len="$2" -max_total_time="$seconds" -timeout=60 \
        -print_final_stats=1 "${@:3}" "corpus/$1" "$root/tests/fuzz/corpus/$1"
}
run scene 8192 -dict="$root/tests/fuzz/gltf.dict"
ASAN_OPTIONS=detect_leaks=0 run options 600 -rss_limit_mb=4096  # drivers keep kernels
