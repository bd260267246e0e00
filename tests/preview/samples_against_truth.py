#!/usr/bin/env python3
"""Every sample, and what lies in ../shared/data, held to truth: `--error` keeps its word; the march at its defaults errs
by at most 2% of single scattering under the sample's suns. A looser error may not be dearer: in work, which is counted, and where
the reference is one of the two in the processor's time as well, which is measured.

    samples_against_truth.py BAKE PREVIEW [--only NAME,NAME] [--errors 10%,3%,1%] [--size 240x135] [--no-defaults] [--rows FILE]

Prints a line a check; exits with 1 where one fails. --rows adds them to FILE as rows of a Markdown table; with --errors "" those of
the march at its defaults. Needs /usr/bin/python3 alone.
"""
import argparse
import json
import pathlib
import re
import sys
import tempfile

from samples import ROOT, add_arguments, add_row, baked, run, with_scenes

DATA = ROOT.parent / "shared" / "data"
# Their point lights stand in the medium: truth has a variance without bound there, and no figure is sure.
POINTS_INSIDE = {"nebula"}
PROCESSOR_SLACK = 1.3  # the processor's time for the same work differs by this much between two runs
DEFAULTS_WITHIN = 0.02
SAMPLES = "1024"  # a pixel, of the march: before altostratus' sun 256 leave 1.5% of noise


def single_scattering(text):
    """The scene of a recipe without octaves, own steps and looks."""
    scene = text[text.index("\nscene:") + 1:]
    return re.sub(r"(?m)^  (octaves|march|look|powder|silver_lining|light_transmittance):.*\n?", "", scene)


def without_sky(scene):
    return re.sub(r"(?m)^  environment:.*\n?", "", scene)


class Checks:
    def __init__(self):
        self.failed = 0

    def that(self, good, sentence):
        print(("ok    " if good else "WRONG ") + sentence, flush=True)
        self.failed += 0 if good else 1


def keeps_its_word(checks, options, name, volume, scene, errors, folder):
    before, row = [], [name]
    for error in errors:
        stats = folder / "stats.json"
        run(options.preview, volume, "--scene", scene, "--render", folder / "x.exr", "--size", options.size, "--error",
            f"{100 * error}%", "--stats", stats)
        said = json.loads(stats.read_text())
        found = said["error"]
        seconds = found["processor_ms"] / 1000
        row.append(f"{100 * found['measured']:.2g}%, {seconds:.2g} s, {found['setting']}")
        checks.that(found["measured"] <= error,
                    f"{name}: asked {error:.0%}, measured {found['measured']:.2%} by {found['setting']} in {seconds:.2g} s")
        for looser in before:
            marches = looser["method"] == found["method"] == "march"
            for cost, slack in (("expected_work", 1),) if marches else (("expected_work", 1), ("processor_ms", PROCESSOR_SLACK)):
                checks.that(looser[cost] <= slack * found[cost],
                            f"{name}: {looser['asked']:.0%} costs {looser[cost]:.4g}, {error:.0%} {found[cost]:.4g} ({cost})")
        before.append(found)
    if errors:
        add_row(options, *row)


def is_near_truth(checks, options, name, volume, scene, folder):
    preview, size = options.preview, options.size
    truth, marched = folder / "truth.exr", folder / "marched.exr"
    run(preview, volume, "--scene", scene, "--render", truth, "--size", size, "--method", "reference", "--bounces", "0",
        "--error", "3%", "--aov")
    run(preview, volume, "--scene", scene, "--render", marched, "--size", size, "--spp", SAMPLES)
    error = json.loads(run(preview, "compare", marched, truth, "--json"))["relative_rmse"]
    checks.that(error <= DEFAULTS_WITHIN, f"{name}: the march at its defaults errs by {error:.2%} of single scattering")
    if not options.errors:
        add_row(options, name, f"{error:.2%}")


def main():
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    parser.add_argument("--errors", default="10%,3%,1%")
    parser.add_argument("--size", default="240x135")
    parser.add_argument("--no-defaults", action="store_true")
    options = parser.parse_args()
    errors = sorted((float(e.strip("%")) / 100 for e in filter(None, options.errors.split(","))), reverse=True)
    wanted = options.only
    checks = Checks()
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for name, recipe in with_scenes().items():
            if wanted and name not in wanted:
                continue
            if name in POINTS_INSIDE:
                print(f"left out: {name}, whose point lights stand in the medium")
                continue
            volume, text = baked(options.bake, name, recipe, folder), recipe.read_text()
            scene, sun = folder / "scene.yaml", folder / "sun.yaml"
            scene.write_text(single_scattering(text))
            sun.write_text(without_sky(single_scattering(text)))
            if not options.no_defaults:
                is_near_truth(checks, options, name, volume, sun, folder)
            keeps_its_word(checks, options, name, volume, scene, errors, folder)
            volume.unlink()
        if not DATA.is_dir():
            print("left out: ../shared/data is missing")
        for volume in sorted(DATA.glob("*.vdb")) if DATA.is_dir() else []:
            if wanted and volume.stem not in wanted:
                continue
            scene = folder / "scene.yaml"
            scene.write_text("scene: { look: physical }\n")
            keeps_its_word(checks, options, volume.stem, volume, scene, errors, folder)
    return checks.failed > 0


if __name__ == "__main__":
    sys.exit(main())
