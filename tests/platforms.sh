#!/usr/bin/env bash
# The test suite on each OpenCL runtime that a CPU can have, and in each form; one table.
#
#   tests/platforms.sh [ROWS] [ctest options]
#
# ROWS, with commas: installed (what the loader finds, PoCL), installed-groups (the form of kernels for
# GPUs), intel and intel-groups (Intel's CPU runtime, from the Python package intel-opencl-rt in a folder
# of the build); default: all. Wants what tests/run.sh has built. For example
#
#   tests/platforms.sh intel -R scene
#
# Exits with 1 where a test failed, 2 where a runtime did not come up.
# SPDX-License-Identifier: MIT
set -euo pipefail

root=$(cd "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
folder=$build/platforms
rows=installed,installed-groups,intel,intel-groups
[[ ${1:-} == -* || $# == 0 ]] || { rows=$1 && shift; }
[[ -x $build/clgi ]] || { echo "platforms: error: no $build/clgi; run tests/run.sh first" >&2 && exit 2; }

# Its libraries but for the loader, which is the system's.
install_intel() {
    local python=$folder/intel/python library
    [[ -f $folder/intel/icd/intel.icd ]] && return
    mkdir -p "$folder/intel/lib" "$folder/intel/icd"
    python3 -m venv "$python"
    "$python/bin/pip" install --quiet intel-opencl-rt intel-cmplr-lib-rt
    for library in "$python"/lib/*; do
        [[ $library == */libOpenCL* ]] || ln -sfn "$library" "$folder/intel/lib/"
    done
    echo "$folder/intel/lib/libintelocl.so" > "$folder/intel/icd/intel.icd"
}

worst=0
table="| runtime | form | device | passed | skipped | failed | s |"$'\n'"| --- | --- | --- | --- | --- | --- | --- |"
for row in ${rows//,/ }; do
    form=packets
    [[ $row == *-groups ]] && form=groups
    settings=("CLGI_FORM=$form")
    case ${row%-groups} in
        installed) ;;
        intel)
            install_intel
            settings+=("OCL_ICD_VENDORS=$folder/intel/icd" "LD_LIBRARY_PATH=$folder/intel/lib"
                "CLGI_CACHE=$folder/intel/cache")
            ;;
        *) echo "platforms: error: '$row' is no row" >&2 && exit 2 ;;
    esac
    device=$(env "${settings[@]}" "$build/clgi" devices | sed -n 's/^\* //p')
    [[ -n $device ]] || { echo "platforms: error: $row: no device" >&2 && exit 2; }
    log=$folder/$row.log
    mkdir -p "$folder"
    started=$SECONDS
    (cd "$build" && env "${settings[@]}" ctest --parallel 2 --no-tests=error --verbose \
        --exclude-regex '_stability$' --label-exclude '^slow$' "$@") > "$log" 2>&1 || worst=1
    count() { grep -c "\[ *$1 *\] .* ms)" "$log" || true; }
    table+=$'\n'"| ${row%-groups} | $form | $device | $(count OK) | $(count SKIPPED) | $(count FAILED) | $((SECONDS - started)) |"
    grep -E '\[ *FAILED *\] .* ms\)|\*\*\*' "$log" || true
done
echo "$table"
exit $worst
