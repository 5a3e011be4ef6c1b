#!/usr/bin/env bash
# What accuracy costs in time, measured again: the figures of docs/results/accuracy.md.
#
#   ./samples/accuracy.sh [mesh.glb]     a mesh for the box; without, a generated one
#
# Writes out/accuracy/<scene>/index.html, plots and tables.
# SPDX-License-Identifier: MIT
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../cmake/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../cmake/setup.sh"
mesh=${1:+$(realpath -- "$1")}
cd "$clgi_root"

clgi_packages+=("${clgi_plot_packages[@]}")
clgi_install_packages
clgi_configure build -DCLGI_TESTS=OFF
clgi_build build clgi_program

out=out/accuracy
mkdir -p "$out"
clgi=build/clgi
"$clgi" scene box ${mesh:+--mesh "$mesh"} -o "$out/box.glb"
"$clgi" scene cornell -o "$out/cornell.glb"
"$clgi" scene corridor --door 90 -o "$out/corridor.glb"
for scene in box cornell; do
    "$clgi" sweep "$out/$scene.glb" -o "$out/$scene"
done
for scene in cornell corridor; do
    "$clgi" sweep "$out/$scene.glb" --method atlas --spp 800 -o "$out/$scene-atlas"
done
"$clgi" scene corridor --door 20 -o "$out/corridor-20.glb"
"$clgi" sweep "$out/cornell.glb" --method antiradiance --spp 768 -o "$out/cornell-antiradiance"
"$clgi" sweep "$out/corridor-20.glb" --method antiradiance --size 160x120 --spp 2048 -o "$out/corridor-antiradiance"
"$clgi" sweep "$out/corridor-20.glb" --convergence --iterations 200 -o "$out/corridor-convergence"
# The environment is a file of its own: sky=FILE.hdr ./samples/accuracy.sh
if [ -n "${sky:-}" ]; then
    "$clgi" scene hand-like -o "$out/hand.glb"
    "$clgi" sweep "$out/hand.glb" --method transfer --time 1 --environment "$sky" -o "$out/hand-transfer"
fi

echo
echo "commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown), $(date +%F)"
echo "pages:" "$out"/*/index.html
