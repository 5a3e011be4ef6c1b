#!/bin/sh
# Runs a program under oclgrind, which must find no data race and no use of what nobody wrote.
#
#   oclgrind.sh path/to/tiny_frame
#
# Exit status 77 stands for "skipped": there is no oclgrind.
# SPDX-License-Identifier: MIT
command -v oclgrind > /dev/null || { echo "oclgrind is not installed: nothing was checked"; exit 77; }
log=$(mktemp) || exit 1
trap 'rm -f "$log"' EXIT
CLGI_DEVICE=oclgrind oclgrind --build-options "-cl-opt-disable -Dalways_inline=noinline" --data-races --uninitialized --log "$log" "$@" || exit 1
if [ -s "$log" ]; then
    head -n 200 "$log"
    exit 1
fi
echo "clean"
