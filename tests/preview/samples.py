"""The samples as the scripts beside this one hold them to truth: which there are, and one of them baked. Depends on Python's
standard library alone.
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FRAME = 20  # of those that are sequences


def run(*command):
    """Runs to the end and returns the stdout; ends this program where it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with {done.returncode}: {done.stderr}")
    return done.stdout


def with_scenes():
    """Recipes that hold a scene, by the names of their assets."""
    paths = sorted((ROOT / "samples").glob("*.yaml"))
    return {path.stem: path for path in paths if "\nscene:" in path.read_text()}


def add_arguments(parser):
    """What all of the scripts are told."""
    parser.add_argument("bake")
    parser.add_argument("preview")
    parser.add_argument("--only", default="", type=lambda text: list(filter(None, text.split(","))))
    parser.add_argument("--rows")


def add_row(options, *cells):
    """Adds a row of a Markdown table to the file of --rows, where there is one, and returns it."""
    line = "| " + " | ".join(cells) + " |"
    if options.rows:
        with open(options.rows, "a", encoding="utf-8") as rows:
            print(line, file=rows)
    return line


def baked(bake, name, recipe, folder):
    """The file that the recipe of that name bakes into the folder; one frame of a sequence."""
    sequence = "\n    frames:" in recipe.read_text()
    run(bake, recipe, "--out", folder, "--quiet", *(["--frames", f"{FRAME}-{FRAME}"] if sequence else []))
    return folder / (f"{name}_{FRAME:04d}.vdb" if sequence else f"{name}.vdb")
