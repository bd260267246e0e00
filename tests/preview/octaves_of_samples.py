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
import tempfile

from samples import ROOT, add_arguments, add_row, baked, run, with_scenes

# Their point lights stand in the medium, and blocks of even density are no clouds.
LEFT_OUT = {"nebula", "cube_constant", "cube_linear", "cube_exponential"}


def recipes(only):
    named = {"cumulus": ROOT / "pipeline.yaml", **{k: v for k, v in with_scenes().items() if k != "cumulus"}}
    return {name: named[name] for name in only or [name for name in named if name not in LEFT_OUT]}


def row(options, name, said, views):
    """The line of those views: before, after and, where it is known, the least."""
    figures = re.search(rf"^{views}: (\S+) before, (\S+) after(?:, (\S+) by)?", said, re.M).groups("")
    share = float(figures[1].strip("%")) / float(figures[0].strip("%"))
    return add_row(options, name, figures[0], figures[1], f"{share:.2f}", figures[2])


def main():
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    parser.add_argument("--halves", action="store_true")
    parser.add_argument("--octaves", default="6")
    parser.add_argument("--size", default="48x36")
    parser.add_argument("--out")
    options = parser.parse_args()
    chosen = recipes(options.only)
    fit = [options.preview, "fit", "--dry-run", "--octaves", options.octaves, "--size", options.size]
    with tempfile.TemporaryDirectory() as temporary:
        files = {name: baked(options.bake, name, recipe, pathlib.Path(temporary)) for name, recipe in chosen.items()}
        if options.halves:
            names = list(files)
            half, other = names[::2], names[1::2]
            chart = ["--out", options.out] if options.out else []
            said = run(*fit, *(files[n] for n in half), *(part for n in other for part in ("--check", files[n])), *chart)
            print(said)
            print(row(options, ", ".join(half), said, "views held back"))
            print(row(options, ", ".join(other), said, "files not fitted to"))
            return
        for name, recipe in chosen.items():
            chart = ["--out", f"{options.out}/{name}"] if options.out else []
            print(row(options, name, run(*fit, files[name], "--scene", recipe, *chart), "views held back"), flush=True)


if __name__ == "__main__":
    main()
