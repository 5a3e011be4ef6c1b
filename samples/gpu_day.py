#!/usr/bin/env python3
"""What clgi does on the default OpenCL device: tests, pictures of every method, tables of the papers.

    samples/gpu_day.py build/ out/ [--minutes 30] [--against FOLDER]

Writes out/report.md, and pictures of the device in out/pictures. With --against, a folder of
pictures that another device made (out/pictures of a run there), each is compared with its twin.
Each part has a share of the time. Pictures that do not fit in it are named; a test that ran out of it
counts as failed, with that reason, and those behind it are missing from the sums.
SPDX-License-Identifier: MIT
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor

BOX = ["scene", "box"]
OFFICE = ["scene", "office"]
# Picture: scene, flags of render.
PICTURES = {
    "box-direct": (BOX, ["--method", "direct"]),
    "box-second-order": (BOX, ["--method", "second-order"]),
    "box-atlas": (BOX, ["--method", "atlas", "--vpls", "400"]),
    "box-antiradiance": (BOX, ["--method", "antiradiance"]),
    "box-cache": (BOX, ["--method", "cache"]),
    "hand-transfer": (["scene", "hand-like"], ["--method", "transfer", "--environment", "1,1.2,1.5"]),
    "corridor-atlas": (["scene", "corridor"], ["--method", "atlas", "--vpls", "1600"]),
    "office-antiradiance": (OFFICE, ["--method", "antiradiance"]),
    "office-cache": (OFFICE, ["--method", "cache"]),
    "window-auto": (["scene", "window", "--seed", "1"], ["--environment", "1,1.2,1.5"]),
}
BENCHES = [["cochran1"], ["cochran2"], ["views"], ["kautz1", "--vertices", "0"], ["kautz2"],
           ["dachsbacher1"], ["dachsbacher2"], ["schaerfig1"], ["animation"], ["layer"]]
FRAMES = 10


def call(command, until, log=None, environment=None):
    """(exit code or None where time ran out, output) of a command that ends by the time `until`."""
    left = until - time.monotonic()
    if left < 1:
        return None, ""
    try:
        done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, text=True,
                              stderr=subprocess.STDOUT, timeout=left, errors="replace",
                              env={**os.environ, **(environment or {})})
        code, output = done.returncode, done.stdout
    except subprocess.TimeoutExpired as late:
        code, output = None, (late.stdout or b"").decode(errors="replace")
    if log:
        log.write_text(output)
    return code, output


def test(program, shard, shards, out, until):
    """A row of the table, and what failed with the first lines about it."""
    name = f"{program.stem}.{shard}"
    begin = time.monotonic()
    code, output = call([program, "--gtest_brief=0"], until, out / f"{name}.log",
                        {"GTEST_TOTAL_SHARDS": str(shards), "GTEST_SHARD_INDEX": str(shard)})
    cases = {}
    for mark, case in re.findall(r"^\[( *OK|  FAILED|  SKIPPED) *\] ([\w/.]+)", output, re.M):
        cases[case] = mark.strip()
    failed = {}
    for case in (case for case, mark in cases.items() if mark == "FAILED"):
        text = output.partition(f"[ RUN      ] {case}\n")[2].partition("[  FAILED  ]")[0]
        failed[case] = " ".join(text.split())[:300]
    running = re.findall(r"^\[ RUN      \] ([\w/.]+)", output, re.M)
    if code != 0 and running and running[-1] not in cases:
        failed[running[-1]] = "ran out of time" if code is None else f"ended with {code}: " + \
            " ".join(output.rsplit("[ RUN      ]", 1)[1].split())[-300:]
    marks = list(cases.values())
    return [name, marks.count("OK"), len(failed), marks.count("SKIPPED"),
            f"{time.monotonic() - begin:.0f}"], failed


def tests(options, report, until):
    programs = sorted((options.build / "tests").glob("*_test"))
    if options.only:
        programs = [program for program in programs if program.stem in options.only.split(",")]
    jobs = [(program, shard) for shard in range(options.shards) for program in programs]
    with ThreadPoolExecutor(options.jobs) as pool:
        rows = list(pool.map(
            lambda job: test(*job, options.shards, options.out / "tests", until), jobs))
    report.write("\n## Tests\n\n| program | passed | failed | skipped | s |\n"
                 "| --- | --- | --- | --- | --- |\n")
    for row, _ in rows:
        report.write(f"| {' | '.join(map(str, row))} |\n")
    report.write("\n")
    for _, failed in rows:
        for case, text in failed.items():
            report.write(f"- `{case}`: {text}\n")
    total = [sum(row[k] for row, _ in rows) for k in (1, 2, 3)]
    report.write(f"\n{total[0]} passed, {total[1]} failed, {total[2]} skipped.\n")


def pictures(options, report, until):
    clgi = options.build / "clgi"
    folder = options.out / "pictures"
    report.write(f"\n## Pictures\n\n640 x 480, median of {FRAMES} frames; the passes that take most "
                 "of a frame.\n\n| picture | frame, ms | before, ms | passes, ms | difference, % |\n"
                 "| --- | --- | --- | --- | --- |\n")
    for name, (scene, flags) in PICTURES.items():
        glb = folder / (name + ".glb")
        call([clgi, *scene, "-o", glb, "--quiet"], until)
        code, output = call([clgi, "render", glb, "--quiet", "--full", "-o", folder / (name + ".exr"),
                             "--png", folder / (name + ".png"), "--frames", FRAMES,
                             "--stats", folder / (name + ".json"), *flags],
                            min(until, time.monotonic() + options.picture_seconds))
        if code != 0:
            text = "not run: no time left" if code is None else " ".join(output.split())[-300:]
            report.write(f"| {name} | {text} | | | |\n")
            continue
        stats = json.loads((folder / (name + ".json")).read_text())
        passes = sorted(stats["passes"], key=lambda row: -row["ms_median"])[:8]
        passes = ", ".join(f"{row['name']} {row['ms_median']:.2f}" for row in passes)
        difference = ""
        if options.against:
            twin = options.against / (name + ".exr")
            code, output = call([clgi, "compare", folder / (name + ".exr"), twin, "--json"], until)
            difference = f"{100 * json.loads(output)['rel_rmse']:.3g}" if code == 0 else output
        report.write(f"| {name} | {stats['frame_ms']['median']:.2f} "
                     f"| {before(stats):.0f} "
                     f"| {passes} | {difference} |\n")
        report.flush()


def before(stats):
    """Milliseconds of what is done once, before the first frame."""
    return sum(part[key] for part in stats.values() if isinstance(part, dict)
               for key in ("layout_ms", "bake_ms", "linking_ms") if key in part)


def benches(options, report, until):
    report.write("\n## Tables of the papers\n")
    for table in BENCHES:
        extra = ["--mesh", options.mesh] if options.mesh and table[0].startswith("cochran") else []
        code, output = call([options.build / "clgi", "bench", *table, *extra, "--quiet"],
                            min(until, time.monotonic() + options.bench_seconds))
        state = "" if code == 0 else " (not to its end)" if code is None else f" (ended with {code})"
        report.write(f"\n`clgi bench {' '.join(table)}`{state}\n\n{output}\n")
        report.flush()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--parts", default="pictures,benches,tests")
    parser.add_argument("--against", type=pathlib.Path)
    parser.add_argument("--mesh", help="of the box in the tables of [Cochran07]")
    parser.add_argument("--only", help="these test programs, with commas")
    parser.add_argument("--shards", type=int, default=4, help="runs that a test program is cut to")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="tests at a time")
    parser.add_argument("--picture-seconds", type=float, default=60)
    parser.add_argument("--bench-seconds", type=float, default=120)
    options = parser.parse_args()
    for folder in ("tests", "pictures"):
        (options.out / folder).mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    parts = options.parts.split(",")
    with open(options.out / "report.md", "w") as report:
        _, listed = call([options.build / "clgi", "devices"], begin + 60)
        report.write(f"# clgi on this device\n\n```\n{listed}```\n")
        for number, part in enumerate(parts, 1):
            until = begin + 60 * options.minutes * number / len(parts)
            {"tests": tests, "pictures": pictures, "benches": benches}[part](options, report, until)
        report.write(f"\n{time.monotonic() - begin:.0f} s in all.\n")


if __name__ == "__main__":
    main()
