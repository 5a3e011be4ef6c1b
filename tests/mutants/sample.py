#!/usr/bin/env python3
"""Wrong lines made by rule: a sample of them, and which ones no test notices.

    tests/mutants/sample.py [--count N] [--seed S] [--only TEXT] [--print] [-b FOLDER]

Rules: another component, a factor or summand left out, a sign turned, a bound moved by one, another
buffer of the same kind. Lines are drawn from all kernels and from the host code of the methods whose
path has TEXT in it. --print writes the list alone; otherwise tests/mutants/run.sh applies one after
the other and runs the programs of its module. Takes minutes an error: a task for a night.
SPDX-License-Identifier: MIT
"""
import argparse
import pathlib
import random
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = {  # who should notice, by folder
    "kernels/parallel": ["core_test", "light_atlas_test"],
    "kernels/scene": ["scene_test", "shading_test"],
    "kernels/gbuffer": ["shading_test", "second_order_test"],
    "kernels/lights": ["shading_test", "second_order_test"],
    "kernels/image": ["shading_test", "second_order_test"],
    "kernels/vpl": ["light_atlas_test"],
    "kernels/atlas": ["light_atlas_test"],
    "kernels/transfer": ["transfer_test"],
    "kernels/antiradiance": ["antiradiance_test"],
    "host/methods/second_order": ["second_order_test"],
    "host/methods/light_atlas": ["light_atlas_test"],
    "host/methods/transfer": ["transfer_test"],
    "host/methods/antiradiance": ["antiradiance_test"],
    "host/renderer": ["renderer_test", "plan_test"],
    "host/shading": ["shading_test", "second_order_test"],
}
NEXT = {"x": "y", "y": "z", "z": "x", "w": "x", "r": "g", "g": "b", "b": "r"}
BOUNDS = {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > "}
FACTOR = r" [*+] (?:[A-Za-z_][\w.]*(?:\[[^\]]*\]|\([^()]*\))?|\d[\d.]*f?)(?=[;,) ])"


def wrong_lines(line, buffers):
    """Every wrong form of a line of code."""
    for match in re.finditer(r"\.([xyzwrgb])\b", line):
        yield line[: match.start(1)] + NEXT[match.group(1)] + line[match.end(1):]
    for match in re.finditer(FACTOR, line):
        yield line[: match.start()] + line[match.end():]
    for match in re.finditer(r" ([+-]) (?=[\w(])", line):
        yield line[: match.start(1)] + "-+"[match.group(1) == "-"] + line[match.end(1):]
    for bound, moved in BOUNDS.items():
        for match in re.finditer(re.escape(bound), line):
            yield line[: match.start()] + moved + line[match.end():]
    for match in re.finditer(r" [+-] 1\b(?![.\w])", line):
        yield line[: match.start()] + line[match.end():]
    for match in re.finditer(r"\b(\w+)\[", line):
        for group in buffers:
            if match.group(1) in group:
                for other in group - {match.group(1)}:
                    yield line[: match.start(1)] + other + line[match.end(1):]


def buffers_of(text):
    """Names of pointer arguments of one type, which may be taken for each other."""
    groups = {}
    for kind, name in re.findall(r"global ((?:const )?\w+\*) restrict (\w+)", text):
        groups.setdefault(kind, set()).add(name)
    return [names for names in groups.values() if len(names) > 1]


def candidates(only):
    for folder, programs in PROGRAMS.items():
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".cl", ".clh", ".cpp") or only not in str(path):
                continue
            text = path.read_text()
            buffers = buffers_of(text)
            for line in text.split("\n"):
                code = line.split("//")[0].rstrip()
                if re.match(r"\s*(#|\*|$)", code) or "restrict" in code or "include" in code:
                    continue
                old = code.strip()
                if len(old) < 8 or text.count(old) != 1:
                    continue
                for new in set(wrong_lines(old, buffers)):
                    if new != old:
                        yield path.relative_to(ROOT), old, new, programs


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--print", action="store_true")
    parser.add_argument("-b", default="")
    options = parser.parse_args()
    found = sorted(candidates(options.only), key=str)
    chosen = random.Random(options.seed).sample(found, min(options.count, len(found)))
    text = f"# {len(chosen)} of {len(found)} wrong lines by rule, seed {options.seed}.\n"
    for path, old, new, programs in chosen:
        text += f"\nfile: {path}\nold: {old}\nnew: {new}\n"
        text += "".join(f"test: {program}\n" for program in programs)
    if options.print:
        print(text, end="")
        return 0
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        file.write(text)
        file.flush()
        command = [str(ROOT / "tests/mutants/run.sh"), "-l", file.name]
        return subprocess.run(command + (["-b", options.b] if options.b else [])).returncode


if __name__ == "__main__":
    sys.exit(main())
