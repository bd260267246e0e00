"""The previewer's window for the tests that drive it: starting, hands, pictures, what it says. Under Xvfb without a window
manager, so that the window lies at the display's corner. Depends on x11.py.
"""
import json
import os
import shutil
import subprocess
import sys
import time

import x11

SKIPPED = 77  # the exit code that ctest counts as "left out"
CHANGED = 2.0  # mean difference of two pictures, of 255, above which a hand has changed something
ALIKE = 1.0    # below which they are the same picture, up to noise
CALM = 0.4     # seconds without a new picture after which none comes
# One sun and nothing else: pictures that a busy machine draws in a blink.
QUICK_LIGHT = """\
look: physical
lights:
  - sun: { to_light: [-0.8, -0.5, 0.4], irradiance: 12 }
"""
PATIENCE = 240.0  # seconds for what should take one: other programs may need the machine


def under_xvfb():
    """Starts this program again under a display of its own, or returns where it runs under one."""
    if os.environ.get("INSIDE_XVFB"):
        return
    for tool in ("xvfb-run", "xdotool"):
        if not shutil.which(tool):
            print(f"left out: {tool} is not installed")
            sys.exit(SKIPPED)
    if x11.load_library() is None:
        print("left out: libX11 is not installed")
        sys.exit(SKIPPED)
    os.environ["INSIDE_XVFB"] = "1"
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1280x800x24", sys.executable, *sys.argv])


class Window:
    """One run of the previewer in a folder."""

    def __init__(self, program, folder, file, *options, size=(240, 160), scene="light.yaml", rest=True):
        """`scene`: QUICK_LIGHT where it is left out; None: the one that files open in. `rest`: waits for a whole picture."""
        self.folder = folder
        (folder / "light.yaml").write_text(QUICK_LIGHT)
        self.log_path = folder / "preview.log"
        self.log = open(self.log_path, "wb")
        self.size = size
        self.process = subprocess.Popen([program, str(file), "--window-size", f"{size[0]}x{size[1]}",
                                         "--stats", "stats.json", *(["--scene", scene] if scene else []), *options],
                                        cwd=folder, stderr=self.log, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        self.screen = x11.Screen()
        self.stats_path = folder / "stats.json"
        self.sent = 0  # presses and releases of keys and buttons, notches of the wheel, drops
        try:
            self.id = self.until(self.find, "no window appeared")
            x11.xdotool("windowfocus", self.id)
            if rest:
                self.settled()
        except BaseException:
            self.kill()
            raise

    def find(self):
        found = x11.xdotool("search", "--pid", self.process.pid, "--name", "Nephele").split()
        return int(found[0]) if found else None

    def said(self):
        return self.log_path.read_text(errors="replace")

    def until(self, condition, complaint):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if self.process.poll() is not None:
                raise AssertionError(f"the program ended with {self.process.returncode}: {self.said()}")
            value = condition()
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"{complaint}\n{self.said()}")

    def until_said(self, sentence, times=1):
        self.until(lambda: self.said().count(sentence) >= times, f"it never said {sentence!r} ({times} times)")

    def key(self, *names):
        for name in names:
            x11.xdotool("key", "--clearmodifiers", name)
            self.sent += 2 * len(name.split("+"))

    def hands(self, *words, presses):
        x11.xdotool(*words)
        self.sent += presses

    def drag(self, start, end, button=1, modifier=None, steps=6):
        """From one place to another; places are shares of the window's sides."""
        def move(place):
            x11.xdotool("mousemove", int(place[0] * self.size[0]), int(place[1] * self.size[1]))
        move(start)
        if modifier:
            self.hands("keydown", modifier, presses=1)
        self.hands("mousedown", button, presses=1)
        for i in range(1, steps + 1):
            move([a + (b - a) * i / steps for a, b in zip(start, end)])
            time.sleep(0.02)
        self.hands("mouseup", button, presses=1)
        if modifier:
            self.hands("keyup", modifier, presses=1)

    def click(self, x, y):
        """At a place in pixels. The panel looks once a frame: it is let see the press before the release."""
        self.hands("mousemove", x, y, "mousedown", 1, presses=1)
        self.until_shown()
        self.hands("mouseup", 1, presses=1)
        self.until_shown()

    def wheel(self, notches):
        """Over the window's middle; towards the screen where `notches` is above 0."""
        self.hands("mousemove", self.size[0] // 2, self.size[1] // 2, "click", "--repeat", abs(notches),
                   4 if notches > 0 else 5, presses=abs(notches))

    def fly(self, key, seconds):
        """Holds the right button and a key for that long."""
        self.hands("mousemove", self.size[0] // 2, self.size[1] // 2, "mousedown", 3, "keydown", key, "sleep", seconds,
                   "keyup", key, "mouseup", 3, presses=4)

    def double_click(self, place):
        self.hands("mousemove", int(place[0] * self.size[0]), int(place[1] * self.size[1]), "click", "--repeat", 2,
                   "--delay", 60, 1, presses=4)

    def drop(self, path):
        self.screen.drop(self.id, path)
        self.sent += 1

    def resize(self, width, height):
        x11.xdotool("windowsize", self.id, width, height)

    def picture(self):
        return self.screen.picture(self.id)

    def stats(self):
        try:
            return json.loads(self.stats_path.read_text())
        except FileNotFoundError:
            return None

    def until_shown(self):
        """Until what all hands so far have done is on the screen, as the program tells."""
        self.until(lambda: self.stat("presses_shown") >= self.sent, "it does not show what hands did")

    def stat(self, key):
        """0 before there are any."""
        return (self.stats() or {}).get(key, 0)

    def settled(self):
        """The picture after all that hands did so far, once its noise is known and nothing begins another. What comes by
        itself, a file that is read, is waited for before."""
        self.until_shown()

        def calm():
            begun, before = self.stat("pictures_begun"), self.picture()
            if not self.stat("noise_known") or before is None:
                return False
            time.sleep(CALM)
            after = self.picture()
            return self.stat("pictures_begun") == begun and after is not None and after.like(before)
        self.until(calm, "the picture does not come to rest")
        return self.picture()

    def until_like(self, picture, complaint, **region):
        """Until the window shows that picture, or a part of it."""
        self.until(lambda: self.shows(picture) and self.picture().difference(picture, **region) < ALIKE, complaint)

    def until_unlike(self, picture, complaint, **region):
        self.until(lambda: self.shows(picture) and self.picture().difference(picture, **region) > CHANGED, complaint)

    def shows(self, picture):
        now = self.picture()
        return now is not None and (now.width, now.height) == (picture.width, picture.height)

    def end(self):
        """Closes the window as its frame would; returns the exit code."""
        self.screen.close(self.id)
        return self.ended()

    def ended(self):
        code = self.process.wait(timeout=PATIENCE)
        self.log.close()
        return code

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
