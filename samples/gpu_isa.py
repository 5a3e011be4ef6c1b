#!/usr/bin/env python3
"""What kernels take of a GPU, without one: registers, stack, local memory, groups a multiprocessor.

    samples/gpu_isa.py build/kernels [--targets sm_90,gfx1100,gfx90a] [--only cache/link_group]

Compiles every installed kernel, one lane wide and in its form for groups, with clang and libclc to
PTX (registers by ptxas, where that is there; libclc has no 64-bit atomics for it, so in two stages)
and to AMD's code, and prints a table. Ends with 1 where
a kernel does not compile, or takes more than --most-stack bytes a lane or --most-local bytes, and with
77 where clang or libclc is not installed.
SPDX-License-Identifier: MIT
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

CLC = pathlib.Path("/usr/lib/clc")
# Lanes of a group, registers of a multiprocessor and of a lane at most, lanes and local memory of it.
# AMD's lanes share a wave of 32 or 64; gfx1100: a pair of compute units.
DEVICES = {"sm_90": (65536, 255, 2048, 233472), "gfx1100": (196608, 256, 2048, 131072),
           "gfx90a": (131072, 512, 2048, 65536)}
WAVE = {"sm_90": 32, "gfx1100": 32, "gfx90a": 64}
GRANULE = {"sm_90": 8, "gfx1100": 24, "gfx90a": 8}  # of registers
DEFINES = {"antiradiance/pull": ["-DCLGI_GROUPS"], "transfer/project_columns": ["-DCLGI_GROUPS"]}
NO_PTXAS, NO_SAMPLERS = "no ptxas", "libclc has no samplers"
FOR_CPUS = {"gbuffer/trace_views"}  # groups rasterise instead
# Kernels that may have more stack than --most-stack, and why.
MORE_STACK = {"cache/reflect": "a walk through the boxes, shadow maps and textures of what rays meet",
              "gbuffer/import_images": "libclc keeps an image of 16 KB for each that it reads"}
GROUP = {"gbuffer/raster_large_group": 32, "gbuffer/raster_views_group": 128,
         "cache/link_group": 32, "antiradiance/global_group": 32, "antiradiance/local_group": 32,
         "antiradiance/gloss_group": 64, "antiradiance/lobes_group": 64}


def run(command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def compiled(source, name, target, folder):
    """(registers, stack, local memory) of a kernel, or the first line of the error."""
    nvidia = target.startswith("sm_")
    triple = "nvptx64--nvidiacl" if nvidia else "amdgcn--amdhsa"
    out = folder / f"{name.replace('/', '.')}.{target}.s"
    code, said = run([OPTIONS.clang, "-target", triple, *([] if nvidia else [f"-mcpu={target}"]),
                      *(["-Xclang", "-target-feature", "-Xclang", "+ptx70", "-Xclang", "-target-cpu",
                         "-Xclang", "sm_70"] if nvidia else []),
                      "-x", "cl", "-cl-std=CL1.2", "-O3", "-Xclang", "-finclude-default-header",
                      "-Xclang", "-mlink-builtin-bitcode", "-Xclang", CLC / f"{triple}.bc",
                      "-nogpulib", "-Xclang", "-cl-ext=+all", "-D__OPENCL_VERSION__=120", "-DCLGI_WIDTH=1", *([] if nvidia else ["-DCLGI_ATOMIC64"]), *DEFINES.get(name, []),
                      "-S", "-o", out, source])
    if code:
        return next((line for line in said.splitlines() if "error" in line), said[:200])
    if not nvidia:
        text = out.read_text()
        found = [re.search(rf"\.{key}:\s*(\d+)", text) for key in
                 ("vgpr_count", "private_segment_fixed_size", "group_segment_fixed_size")]
        return tuple(int(one.group(1)) for one in found)
    if not OPTIONS.ptxas:
        return NO_PTXAS
    code, said = run([OPTIONS.ptxas, f"-arch={target}", "-v", "-o", os.devnull, out])
    if code:
        return NO_SAMPLERS if "sampler_initializer" in said else said.splitlines()[0]
    local = re.search(r"(\d+) bytes smem", said)
    return (int(re.search(r"Used (\d+) registers", said).group(1)),
            int(re.search(r"(\d+) bytes stack frame", said).group(1)),
            int(local.group(1)) if local else 0)


def lanes_at_once(target, name, registers, local):
    """Share of the lanes of a multiprocessor that registers and local memory leave."""
    file, most, lanes, memory = DEVICES[target]
    group = GROUP.get(name, 64)
    taken = -(-group // WAVE[target]) * WAVE[target]
    granule = GRANULE[target]
    by_registers = min(file // (-(-max(registers, 1) // granule) * granule * taken),
                       lanes // taken)
    by_memory = memory // local if local else by_registers
    return min(1.0, min(by_registers, by_memory) * group / lanes) if registers <= most else 0.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("kernels", type=pathlib.Path)
    parser.add_argument("--targets", default="sm_90,gfx1100,gfx90a")
    parser.add_argument("--only", help="these kernels, with commas")
    parser.add_argument("--most-stack", type=int, default=512, help="bytes a lane")
    parser.add_argument("--most-local", type=int, default=32768, help="bytes a group")
    parser.add_argument("--clang", default="clang-15")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    global OPTIONS
    OPTIONS = parser.parse_args()
    for needed in (OPTIONS.clang, CLC):
        if not shutil.which(needed) and not pathlib.Path(needed).exists():
            print(f"gpu_isa: {needed} is not installed")
            sys.exit(77)
    OPTIONS.ptxas = shutil.which("ptxas") or shutil.which("/usr/local/cuda/bin/ptxas")
    names = sorted(str(path.relative_to(OPTIONS.kernels).with_suffix(""))
                   for path in OPTIONS.kernels.rglob("*.cl"))
    names = [name for name in names if name + "_group" not in names and name not in FOR_CPUS]
    if OPTIONS.only:
        names = [name for name in names if name in OPTIONS.only.split(",")]
    if not names:
        sys.exit(f"no kernel in {OPTIONS.kernels}")
    targets = OPTIONS.targets.split(",")
    print("| kernel | " + " | ".join(f"{target}: registers, stack, local, lanes"
                                     for target in targets) + " |")
    print("| --- |" + " --- |" * len(targets))
    failed = []
    with tempfile.TemporaryDirectory() as folder:
        def row(name):
            return [compiled(OPTIONS.kernels / f"{name}.cl", name, target, pathlib.Path(folder))
                    for target in targets]

        with concurrent.futures.ThreadPoolExecutor(OPTIONS.jobs) as pool:
            for name, found in zip(names, pool.map(row, names)):
                cells = []
                for target, one in zip(targets, found):
                    if isinstance(one, str):
                        cells.append(one)
                        if one not in (NO_PTXAS, NO_SAMPLERS):
                            failed.append(f"{name}, {target}: {one}")
                        continue
                    registers, stack, local = one
                    share = lanes_at_once(target, name, registers, local)
                    cells.append(f"{registers}, {stack}, {local}, {100 * share:.0f} %")
                    large = stack > OPTIONS.most_stack and name not in MORE_STACK
                    if large or local > OPTIONS.most_local:
                        failed.append(f"{name}, {target}: {stack} bytes of stack, {local} of local "
                                      "memory")
                print(f"| {name} | {' | '.join(cells)} |", flush=True)
    for name, why in MORE_STACK.items():
        print(f"not held to {OPTIONS.most_stack} bytes of stack: {name} ({why})", file=sys.stderr)
    for line in failed:
        print(line, file=sys.stderr)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
