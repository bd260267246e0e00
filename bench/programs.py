"""What the scripts that hold the programs against others share: where they lie, and running to the end. Depends on Python's
standard library.
"""
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BAKE, PREVIEW = ROOT / "build/nephele-bake", ROOT / "build/nephele-preview"
RECIPE = ROOT / "bench/cycles_ball.yaml"


def timed(command):
    """Runs to the end, or ends this program; returns the seconds that it took, its stdout and its stderr."""
    start = time.monotonic()
    done = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return time.monotonic() - start, done.stdout, done.stderr


def said(command):
    """The same for stdout alone."""
    return timed(command)[1]
