#!/usr/bin/env bash
# From a fresh clone to tested: installs packages, builds, runs the tests.
#
#   tests/run.sh [--all|--slow] [cmake options]     for example -DCLGI_WERROR=ON
#
# Without --all those are left out that take longest (label "slow", tests/CMakeLists.txt): users of
# an installed clgi, kernels in an interpreter, every kernel in every form, kernels compiled for GPUs,
# the longest sweeps and references. --slow runs these alone; continuous integration does so in a job of its own. The
# entries of the stability suite are always left out: they repeat cases of the shards.
#
# Ends with ctest's summary and its exit code. A run without a test on an OpenCL device fails.
# SPDX-License-Identifier: MIT
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=../cmake/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../cmake/setup.sh"

left_out=(--exclude-regex '_stability$')
part=default
case ${1:-} in
    --all | --slow) part=${1#--} && shift ;;
esac
[[ $part == default ]] && left_out+=(--label-exclude '^slow$')
[[ $part == slow ]] && left_out+=(--label-regex '^slow$')
[[ $part == default ]] || clgi_packages+=(clang-15 libclc-15)  # of samples/gpu_isa.py
[[ $part == default ]] || export CLGI_ALL_WIDTHS=1  # packets of all widths, not only the device's

build=$clgi_root/build
clgi_packages+=("${clgi_plot_packages[@]}")
clgi_install_packages
clgi_configure "$build" -DCLGI_TESTS=ON "$@"
clgi_build "$build"

cd "$build"
on_device=$(ctest -N --label-regex '^device$' | sed -n 's/^ *Test *#[0-9]*: //p')

# Two at a time: most of a test's time is the build of its kernels, which takes one core.
log=$build/ctest.log
ctest --output-on-failure --no-tests=error --parallel 2 "${left_out[@]}" 2>&1 | tee "$log"

grep -A1 ': Skipped$' Testing/Temporary/LastTest.log || echo "tests: no case was skipped"
if [[ $part == default ]]; then
    echo "tests: $(ctest -N --label-regex '^slow$' | sed -n 's/^Total Tests: //p') slow ones are left to --slow or --all"
fi
for test in $on_device; do
    grep -Eq "Test +#[0-9]+: $test \.+ +Passed" "$log" && exit 0
done
echo "tests: error: no test ran on an OpenCL device" >&2
exit 1
