#!/usr/bin/env python3
"""What fitting the octaves' factors brings, on the samples: `nephele-preview fit` on each alone, or one set of factors over
half of them, measured on the other half.

    octaves_of_samples.py BAKE PREVIEW [--only NAME,NAME] [--halves] [--octaves 6] [--size 48x36] [--rows FILE] [--out FOLDER]

Prints a row of a Markdown table a sample: errors against the reference with factors of 0.5, with fitted ones, and the least that
any factors leave, on cameras and suns held back. `cumulus` is the default recipe's. Nothing is judged. Needs /usr/bin/python3
alone.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEFAULT = ROOT / "pipeline.yaml"
FRAME = 20  # of those that are sequences
# Their point lights stand in the medium, and blocks of even density are no clouds.
LEFT_OUT = {"nebula", "cube_constant", "cube_linear", "cube_exponential"}


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with {done.returncode}: {done.stderr}")
    return done.stdout


def recipes(only):
    found = [DEFAULT] + [path for path in sorted((ROOT / "samples").glob("*.yaml")) if path.stem != "cumulus"]
    named = {("cumulus" if path == DEFAULT else path.stem): path for path in found}
    chosen = only or [name for name, path in named.items() if name not in LEFT_OUT and "\nscene:" in path.read_text()]
    return {name: named[name] for name in chosen}


def baked(bake, name, recipe, folder):
    sequence = "\n    frames:" in recipe.read_text()
    run(bake, recipe, "--out", folder, "--quiet", *(["--frames", f"{FRAME}-{FRAME}"] if sequence else []))
    return folder / (f"{name}_{FRAME:04d}.vdb" if sequence else f"{name}.vdb")


def row(name, said, views):
    """The line of those views: before, after and, where it is known, the least."""
    figures = re.search(rf"^{views}: (\S+) before, (\S+) after(?:, (\S+) by)?", said, re.M).groups("")
    share = float(figures[1].strip("%")) / float(figures[0].strip("%"))
    return f"| {name} | {figures[0]} | {figures[1]} | {share:.2f} | {figures[2]} |"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bake")
    parser.add_argument("preview")
    parser.add_argument("--only", default="")
    parser.add_argument("--halves", action="store_true")
    parser.add_argument("--octaves", default="6")
    parser.add_argument("--size", default="48x36")
    parser.add_argument("--rows")
    parser.add_argument("--out")
    options = parser.parse_args()
    chosen = recipes(list(filter(None, options.only.split(","))))
    fit = [options.preview, "fit", "--dry-run", "--octaves", options.octaves, "--size", options.size]
    with tempfile.TemporaryDirectory() as temporary:
        files = {name: baked(options.bake, name, recipe, pathlib.Path(temporary)) for name, recipe in chosen.items()}
        rows = []
        if options.halves:
            names = list(files)
            half, other = names[::2], names[1::2]
            chart = ["--out", options.out] if options.out else []
            said = run(*fit, *(files[n] for n in half), *(part for n in other for part in ("--check", files[n])), *chart)
            print(said)
            rows += [row(", ".join(half), said, "views held back"), row(", ".join(other), said, "files not fitted to")]
        else:
            for name, recipe in chosen.items():
                chart = ["--out", f"{options.out}/{name}"] if options.out else []
                rows.append(row(name, run(*fit, files[name], "--scene", recipe, *chart), "views held back"))
                print(rows[-1], flush=True)
    for line in rows if options.halves else []:
        print(line)
    if options.rows:
        with open(options.rows, "a", encoding="utf-8") as file:
            file.write("".join(line + "\n" for line in rows))


if __name__ == "__main__":
    main()
