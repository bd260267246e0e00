"""Runs the project's programs for the command tests: with a time limit, a memory limit and in a folder of its own.

Where the programs lie comes from ctest: NEPHELE_BAKE, NEPHELE_PREVIEW, NEPHELE_TOLERANCES (paths), NEPHELE_SANITIZED
(0 or 1). Depends on Python's standard library alone.
"""
import json
import os
import resource
import signal
import subprocess

LIMIT_SECONDS = 60
LIMIT_BYTES = 4 << 30  # of address space; a damaged file must not make a program ask for more
SANITIZED_LIMIT_MB = 2048  # of resident memory; the sanitizer's shadow reserves terabytes of addresses
SKIPPED = 77  # the exit code that ctest counts as "left out"

BAKE = os.environ.get("NEPHELE_BAKE", "build/nephele-bake")
PREVIEW = os.environ.get("NEPHELE_PREVIEW", "build/nephele-preview")
TOLERANCES = os.environ.get("NEPHELE_TOLERANCES", "build/bench/nephele_tolerances")
SANITIZED = os.environ.get("NEPHELE_SANITIZED", "0") == "1"

# A bake that takes a blink: a ball of about 4000 voxels.
SMALL_RECIPE = """\
assets:
  ball:
    voxel_size: 0.1
    density:
      sphere: { radius: 1.0, falloff: 0.5 }
"""


def _environment():
    limit = f"hard_rss_limit_mb={SANITIZED_LIMIT_MB}"
    return {**os.environ, "ASAN_OPTIONS": limit} if SANITIZED else None


def _limits(file_bytes):
    def apply():
        if not SANITIZED:
            resource.setrlimit(resource.RLIMIT_AS, (LIMIT_BYTES, LIMIT_BYTES))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if file_bytes is not None:  # a write beyond it fails, as on a full disk
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_bytes, file_bytes))
    return apply


def run(command, folder, file_bytes=None):
    """Runs a list of words in `folder`; returns subprocess.CompletedProcess with text. A hang raises TimeoutExpired."""
    return subprocess.run(command, cwd=folder, env=_environment(), preexec_fn=_limits(file_bytes), text=True,
                          errors="replace", stdin=subprocess.DEVNULL, capture_output=True, timeout=LIMIT_SECONDS)


def start(command, folder):
    """Starts a program and returns its subprocess.Popen, for tests that end it themselves."""
    return subprocess.Popen(command, cwd=folder, env=_environment(), stdin=subprocess.DEVNULL,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def run_well(command, folder):
    """As run(), for commands that must succeed; raises AssertionError with what they said."""
    done = run(command, folder)
    assert done.returncode == 0, f"{' '.join(command)}: exit {done.returncode}\n{done.stdout}{done.stderr}"
    return done


def info(file, folder):
    """What `nephele-bake info --json` says of one file."""
    said = json.loads(run_well([BAKE, "info", file, "--json"], folder).stdout)
    return said[0] if isinstance(said, list) else said.get("files", [said])[0]


def run_in_blender(script, arguments, seconds):
    """The exit code of a script that Blender runs, with what it finds behind `--`."""
    # The system's Python alone: another one's variables would keep Blender from starting.
    blender = ["env", "-u", "PYTHONHOME", "-u", "PYTHONPATH", "blender", "-b", "--factory-startup", "-noaudio",
               "--python-exit-code", "1", "--python", str(script), "--", *arguments]
    return subprocess.run(blender, stdin=subprocess.DEVNULL, timeout=seconds).returncode
