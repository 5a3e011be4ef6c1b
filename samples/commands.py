"""Commands of clgi, run by the scripts beside this file.

SPDX-License-Identifier: MIT
"""
import argparse
import subprocess
import sys


def arguments(description):
    """A parser for scripts that take the program and a folder."""
    parser = argparse.ArgumentParser(description=description,
                                     formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("clgi", help="the program")
    parser.add_argument("out", help="folder for pictures")
    return parser


def run(*command):
    """What a command printed; a failure ends the script with its error line."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout
