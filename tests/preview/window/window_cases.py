#!/usr/bin/env python3
"""Drives the previewer's window as hands would and reads its pictures: drags, keys, drops, reloads, sequences, sizes, closing.

usage: window_cases.py PREVIEW MAKE_BALL [CASE...]     each case is a function below; exit 77: left out
Depends on window.py and png.py.
"""
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import png
from window import ALIKE, CHANGED, Window, under_xvfb

PREVIEW, MAKE_BALL = sys.argv[1:3]
TRIES = 10
BALL_SHOWS = 40  # of 255: the ball against the backdrop beside it
FLIGHT = 0.4  # seconds
# Pixels of a window in which the panel stands open, and of widgets in it.
WITH_PANEL = (800, 450)
BESIDE_PANEL = 0.35  # of the width: what lies right of that is picture
GRID, UNDO, EXPOSURE, ELEVATION = (60, 61), (35, 82), (95, 153), (30, 239)
ENTRY = 17  # height of an entry of the chooser
OPENED = []  # windows of the case that runs, to be ended with it


def make_ball(path, *words):
    """Written as a bake writes: whole under another name, then renamed."""
    partial = path.with_suffix(".partial")
    subprocess.run([MAKE_BALL, str(partial), *map(str, words)], check=True)
    partial.rename(path)


def open_window(folder, file, *options, **more):
    window = Window(PREVIEW, folder, file, *options, **more)
    OPENED.append(window)
    with_panel = window.picture()
    window.key("h")  # pictures without the panel
    assert window.settled().difference(with_panel, bottom=0.12) > CHANGED, "H does not hide the panel"
    return window


def camera_moves_and_comes_back(folder):
    make_ball(folder / "ball.vdb")
    w = open_window(folder, "ball.vdb")
    first = w.picture()
    w.key("ctrl+1")
    w.until_said("bookmark 1 is set")
    w.drag((0.6, 0.5), (0.3, 0.6))
    orbited = w.settled()
    assert orbited.difference(first) > CHANGED, "the drag did not orbit"
    w.drag((0.6, 0.5), (0.8, 0.5), button=2)
    panned = w.settled()
    assert panned.difference(orbited) > CHANGED, "the middle drag did not pan"
    w.drag((0.6, 0.5), (0.55, 0.5), button=3)
    w.until_unlike(panned, "the right drag did not look around")
    w.key("2")
    w.until_said("bookmark 2 is not set")
    w.key("1")
    w.until_like(first, "the bookmark does not come back")
    for _ in range(TRIES):  # on a busy machine two clicks may be seen too far apart to be one double click
        w.double_click((0.5, 0.62))
        time.sleep(1.0)
        if w.picture().difference(first) > CHANGED:
            break
    w.until_unlike(first, "the double click focused on nothing")
    w.key("Home")
    w.until_like(first, "Home does not frame the cloud")
    assert w.end() == 0


def sun_turns_and_undo_turns_it_back(folder):
    make_ball(folder / "ball.vdb")
    w = open_window(folder, "ball.vdb")
    first = w.picture()
    w.drag((0.3, 0.5), (0.8, 0.6), modifier="ctrl", steps=12)
    turned = w.settled()
    assert turned.difference(first) > CHANGED, "the sun did not turn"
    w.key("ctrl+z")  # the whole drag is one step
    w.until_like(first, "undo does not bring the sun back")
    w.key("ctrl+shift+z")
    w.until_like(turned, "redo does not turn it again")
    w.key("ctrl+z", "ctrl+z")
    w.until_said("nothing to undo")
    w.key("l")
    w.until_said("look: report")
    w.until_unlike(first, "the looks do not differ")
    assert w.end() == 0


def views_and_split(folder):
    make_ball(folder / "ball.vdb")
    w = open_window(folder, "ball.vdb")
    pictures = [w.picture()]
    for view in ("transmittance", "optical depth", "density slice", "steps per pixel", "skipped share"):
        w.key("v")
        w.until_said(f"view: {view}")
        pictures.append(w.settled())
        assert all(pictures[-1].difference(p) > CHANGED for p in pictures[:-1]), f"{view} looks like another view"
    w.key("v")
    w.until_said("view: radiance")
    first = w.settled()
    w.key("c")
    w.drag((0.75, 0.3), (0.95, 0.45), modifier="ctrl")  # a sun of its own for the right side
    w.until_unlike(first, "the right side does not follow", left=0.55)
    w.until_like(first, "the left side is not kept", right=0.45)
    w.drag((0.5, 0.9), (0.9, 0.9))  # the divider
    w.until_like(first, "the divider did not move", right=0.85)
    w.drag((0.9, 0.9), (0.5, 0.9))
    w.key("x")
    w.until_like(first, "the sides did not swap", left=0.55)
    w.until_unlike(first, "both sides are the same", right=0.45)
    assert w.end() == 0


def first_picture_is_the_clouds_alone(folder):
    make_ball(folder / "ball.vdb")
    w = Window(PREVIEW, folder, "ball.vdb", size=WITH_PANEL, rest=False)
    OPENED.append(w)
    for _ in range(TRIES):  # coarse pictures, then better ones
        w.until(lambda: w.picture() is not None and w.picture().mean() > 5.0, "no picture")
        picture = w.picture()
        # Beneath panel and ball stands the same backdrop on both sides.
        left, right = (picture.mean(left=a, right=a + 0.25, top=0.985) for a in (0.05, 0.7))
        assert abs(left - right) < ALIKE, f"the panel left its mark: {left:.1f} against {right:.1f}"
    assert w.end() == 0


def wheel_and_flight(folder):
    make_ball(folder / "ball.vdb")
    w = open_window(folder, "ball.vdb")
    first = w.picture()
    w.wheel(3)
    w.until_unlike(first, "the wheel does not zoom")
    w.wheel(-3)
    w.until_like(first, "the wheel back does not zoom back")
    for key in ("w", "s", "d", "a", "e", "q"):
        w.fly(key, FLIGHT)
        w.until_unlike(first, f"{key} does not fly")
        w.key("r")
        w.until_like(first, "R does not come back")
    w.key("w", "d")  # without the right button they do nothing
    w.key("l")
    w.until_said("look: report")
    w.key("l")
    w.until_like(first, "keys fly without the right button")
    assert w.end() == 0


def grid_chooser(folder):
    make_ball(folder / "five.vdb", "five")
    w = Window(PREVIEW, folder, "five.vdb", size=WITH_PANEL)
    OPENED.append(w)
    first = w.picture()

    def choose(place):
        w.click(*GRID)
        w.click(GRID[0], GRID[1] + ENTRY * (place + 1) + ENTRY // 4)
    choose(3)
    w.until_said("showing grid 'smoke'")
    w.until_unlike(first, "the smoke looks like the density", left=BESIDE_PANEL)
    choose(1)
    w.until_said("grid 'surface' is a level set")
    choose(2)  # vel: no density, and not to be chosen
    w.key("Escape")  # folds the list, and does not end the program
    w.until_shown()
    choose(0)
    w.until_like(first, "the density does not come back", left=BESIDE_PANEL, top=0.25)
    assert w.end() == 0


def a_slider_and_its_undo(folder):
    make_ball(folder / "ball.vdb")
    w = Window(PREVIEW, folder, "ball.vdb", size=WITH_PANEL)
    OPENED.append(w)
    first = w.picture()
    cloud = {"left": BESIDE_PANEL, "top": 0.25}
    for place, what in ((EXPOSURE, "exposure"), (ELEVATION, "elevation")):
        w.click(*place)
        w.until_unlike(first, f"a click on the {what} changes nothing", **cloud)
        w.click(*UNDO)
        w.until_like(first, f"the button does not undo the {what}", **cloud)
        w.key("ctrl+y")
        w.until_unlike(first, f"redo does not bring the {what} back", **cloud)
        w.key("ctrl+z")
        w.until_like(first, f"the keys do not undo the {what}", **cloud)
    assert w.end() == 0


def drops(folder):
    make_ball(folder / "ball.vdb")
    make_ball(folder / "small.vdb", "ball", 9)
    make_ball(folder / "surface.vdb", "level_set")
    make_ball(folder / "hollow.vdb", "empty")
    (folder / "text.vdb").write_text("no volume")
    (folder / "scene.yaml").write_text("lights: []\nenvironment: { constant: [0, 0, 0], show: true }\n")
    (folder / "wrong.yaml").write_text("lihgts: []\n")
    (folder / "stage.yaml").write_text("stage: {}\n")
    w = open_window(folder, "ball.vdb")
    first = w.picture()
    for name, sentence in (("text.vdb", "text.vdb: error"), ("surface.vdb", "no float grid that is a fog volume"),
                           ("wrong.yaml", "unknown key 'lihgts'"), ("preview.log", "is no .vdb, no .yaml")):
        w.drop(folder / name)
        w.until_said(sentence)
        assert w.picture().difference(first) < ALIKE, f"{name} changed the picture"
    w.drop(folder / "hollow.vdb")
    w.until_said("is empty: there is no density to show")
    w.drop(folder / "small.vdb")
    w.until_said("opened small.vdb")
    w.settled()
    w.drop(folder / "scene.yaml")
    w.until_said("took over the scene of scene.yaml")
    w.until(lambda: w.picture().mean() < 5.0, "a scene without light is not black")
    w.key("ctrl+z")
    w.until(lambda: w.picture().mean() > 20.0, "undo does not bring the scene before back")
    below = w.settled()
    w.drop(folder / "stage.yaml")  # clouds are framed from below, and a floor would hide them
    w.until_said("beneath the stage's floor, and stands above it now")
    above = w.settled()
    assert above.difference(below) > CHANGED, "there is no stage"
    w.key("ctrl+z")
    w.until_like(below, "undo takes the stage away, and not the camera back")
    w.key("ctrl+y")
    w.until_like(above, "redo does not bring stage and camera back")
    assert w.end() == 0


def reload(folder):
    make_ball(folder / "ball.vdb")
    w = open_window(folder, "ball.vdb")
    first = w.picture()
    make_ball(folder / "ball.vdb", "ball", 10)
    w.until_said("read ball.vdb again")
    smaller = w.settled()
    assert smaller.difference(first) > CHANGED, "the new bake does not show"
    (folder / "ball.vdb").write_bytes(b"cut short")
    w.until_said("what was read before stays")
    assert w.picture().difference(smaller) < ALIKE, "a file that does not load changed the picture"
    make_ball(folder / "ball.vdb")
    w.until_said("read ball.vdb again", times=2)
    w.until_like(first, "the first bake does not come back")
    assert w.end() == 0


def sequence(folder):
    for number, radius in ((1, 20), (2, 16), (4, 8), (5, 12)):
        make_ball(folder / f"s_{number:04}.vdb", "ball", radius)
    (folder / "s_0003.vdb").write_text("bad")
    w = open_window(folder, "s_0001.vdb")
    first = w.picture()
    w.key("Right")
    w.until_unlike(first, "the next frame does not show")
    second = w.settled()
    w.key("Right")
    w.until_said("s_0003.vdb: error")
    assert w.picture().difference(second) < ALIKE, "the bad frame changed the picture"
    w.key("space")
    w.until_said("s_0003.vdb: error", times=2)  # played round, and over it again
    w.key("space")
    assert w.end() == 0


def sizes_and_files(folder):
    make_ball(folder / "ball.vdb")
    w = open_window(folder, "ball.vdb")
    first = w.picture()
    w.resize(1, 1)
    time.sleep(0.5)
    w.resize(*w.size)
    w.until_like(first, "the picture is another after 1x1 and back")
    w.key("F12")
    w.until_said("wrote nephele_0001.png")
    w.key("shift+F12")
    w.until_said("wrote nephele_0002.exr")
    assert png.spread_along_rows(folder / "nephele_0001.png") > BALL_SHOWS, "the picture is blank"
    w.key("ctrl+s")
    w.until_said("wrote ball.scene.yaml")
    w.drag((0.6, 0.5), (0.3, 0.6))
    w.settled()
    w.key("ctrl+o")
    w.until_said("took over the scene of ball.scene.yaml")
    w.until_like(first, "the saved scene is another")
    w.key("F1")
    w.until_unlike(first, "F1 lists nothing")
    w.key("Escape")  # closes the list, not the window
    w.until_like(first, "Escape does not close the list")
    w.key("Escape")
    assert w.ended() == 0
    assert w.stats()["gl_objects_made"] > 0
    assert not (folder / "imgui.ini").exists(), "a file was left behind"


CASES = [first_picture_is_the_clouds_alone, camera_moves_and_comes_back, wheel_and_flight, sun_turns_and_undo_turns_it_back,
         views_and_split, grid_chooser, a_slider_and_its_undo, drops, reload, sequence, sizes_and_files]


def main():
    under_xvfb()
    wanted = sys.argv[3:]
    failed = 0
    for case in CASES:
        if wanted and case.__name__ not in wanted:
            continue
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as name:
            try:
                case(Path(name))
                print(f"passed  {case.__name__}  {time.monotonic() - start:.1f} s")
            except AssertionError as error:
                failed += 1
                print(f"FAILED  {case.__name__}: {error}")
            finally:
                for window in OPENED:
                    window.kill()
                OPENED.clear()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
