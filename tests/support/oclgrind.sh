#!/bin/sh
# Runs a program under oclgrind, which must find no access outside a buffer and no data race.
# (Its check for uninitialised values crashes on these kernels, version 21.10.)
#
#   oclgrind.sh path/to/program
#
# Exit status 77 stands for "skipped": there is no oclgrind.
# SPDX-License-Identifier: MIT
command -v oclgrind > /dev/null || { echo "oclgrind is not installed: nothing was checked"; exit 77; }
log=$(mktemp) || exit 1
none=$(mktemp -d) || exit 1
trap 'rm -rf "$log" "$none"' EXIT
# No other platform in the process: two LLVMs in one do not get along. The build options keep
# clang from instructions that this oclgrind does not know, and from the one look past an atomic.
CLGI_DEVICE=oclgrind OCL_ICD_VENDORS=$none/ oclgrind \
    --build-options "-cl-opt-disable -Dalways_inline=noinline -DCLGI_ATOMICS_ONLY" \
    --data-races --log "$log" "$@" || exit 1
if [ -s "$log" ]; then
    head -n 200 "$log"
    exit 1
fi
echo "clean"
