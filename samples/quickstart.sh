#!/usr/bin/env bash
# From a fresh clone to a picture: installs packages, builds, renders a mesh in a coloured box.
#
#   samples/quickstart.sh [MESH]     MESH: a .glb or .gltf file, such as the Stanford bunny;
#                                    without it a generated mesh of as many triangles
#
# Build in ./build, results in ./out, both beside this folder.
# SPDX-License-Identifier: MIT
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=../cmake/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../cmake/setup.sh"

mesh=()
if (($# > 0)); then
    [[ -r $1 ]] || { echo "quickstart: error: $1 cannot be read" >&2; exit 2; }
    mesh=(--mesh "$1")
fi

clgi_install_packages
clgi_configure "$clgi_root/build"
clgi_build "$clgi_root/build" clgi_program

clgi=$clgi_root/build/clgi
out=$clgi_root/out
mkdir -p "$out"
"$clgi" devices
"$clgi" scene box "${mesh[@]}" -o "$out/box.glb"
"$clgi" render "$out/box.glb" -o "$out/box.exr" --png "$out/box.png" \
    --stats "$out/box.json"
echo "picture: $out/box.png (radiance: $out/box.exr, times by pass: $out/box.json)"
