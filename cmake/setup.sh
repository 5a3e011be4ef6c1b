# Packages and build, once for samples/quickstart.sh, tests/run.sh and .ci/run. To be sourced.
# SPDX-License-Identifier: MIT
# shellcheck shell=bash

clgi_root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)

# Debian and Ubuntu names.
clgi_packages=(
    g++ cmake ninja-build pkg-config                                             # build
    ocl-icd-opencl-dev opencl-clhpp-headers opencl-headers libglm-dev libstb-dev # clgi::clgi
    libopenexr-dev libpng-dev nlohmann-json3-dev libtinygltf-dev                 # clgi::io
    libmeshoptimizer-dev libdraco-dev libwebp-dev                                # its codecs
    libepoxy-dev libegl-dev libegl1 libegl-mesa0 libgl1-mesa-dri                 # clgi::gl
    libmeshoptimizer-dev                                                         # clgi::mesh
    libembree-dev libtbb-dev                                                     # clgi::reference
    libcli11-dev libfmt-dev libglfw3-dev libimgui-dev                            # the program
    pocl-opencl-icd                                                              # OpenCL on CPUs
    libgtest-dev oclgrind dpkg-dev xvfb xdotool                                  # tests
)

# Plots of sweeps, scale bars and sheets: 60 MB of downloads that a first picture does not need.
# shellcheck disable=SC2034  # by those who source this
clgi_plot_packages=(python3-matplotlib python3-jinja2)

# Installs what is missing; does nothing, and needs no rights, when nothing is.
clgi_install_packages() {
    local package missing=()
    for package in "${clgi_packages[@]}"; do
        [[ $(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null) == ii* ]] ||
            missing+=("$package")
    done
    ((${#missing[@]} == 0)) && return
    if ! command -v apt-get >/dev/null; then
        echo "clgi: no apt-get here; needed, by their Debian names: ${clgi_packages[*]}" >&2
        return  # they may be there under other names: the build will tell
    fi
    local as_root=()
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            echo "clgi: error: run as root or install sudo; missing packages: ${missing[*]}" >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    echo "clgi: installing ${missing[*]}"
    "${as_root[@]}" apt-get -q update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -q install -y --no-install-recommends "${missing[@]}"
}

# clgi_configure FOLDER [cmake options]: a Release build with Ninja, in a new folder or an old one.
clgi_configure() {
    local folder=$1
    shift
    local generator=(-G Ninja)
    [[ -f $folder/CMakeCache.txt ]] && generator=()  # an old folder keeps the one it has
    cmake -S "$clgi_root" -B "$folder" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release "$@"
}

# clgi_build FOLDER [target]
clgi_build() {
    cmake --build "$1" --parallel "$(nproc)" --target "${2:-all}"
}
