"""Commands of clgi, run by the scripts beside this file.

SPDX-License-Identifier: MIT
"""
import subprocess
import sys


def run(*command):
    """What a command printed; a failure ends the script with its error line."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout
