#!/bin/sh
# Builds a program against an installed clgi through pkg-config.
#
#   pkgconfig.sh COMPILER SOURCE PROGRAM MODULES [--static]     with PKG_CONFIG_PATH set
#
# SPDX-License-Identifier: MIT
set -eu
compiler=$1 source=$2 program=$3 modules=$4
shift 4
flags=$(pkg-config --cflags --libs "$@" $modules)
echo "$flags"
# Word by word: flags are a list.
# shellcheck disable=SC2086
exec $compiler -std=c++17 -O1 "$source" -o "$program" $flags
