"""A hand and an eye on an X display for the window tests: pictures of windows, drops, closing, through libX11 by ctypes.

Mouse and keys go through xdotool. Depends on Python's standard library, libX11 and xdotool.
"""
import ctypes
import subprocess
import time
from ctypes import POINTER, Structure, Union, byref, c_char_p, c_int, c_long, c_ubyte, c_uint, c_ulong, c_void_p
from pathlib import Path

CLIENT_MESSAGE, SELECTION_NOTIFY, SELECTION_REQUEST = 33, 31, 30
ALL_PLANES, Z_PIXMAP, COPY_FROM = ctypes.c_ulong(-1), 2, 0
XDND_VERSION = 5


class ClientMessage(Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p), ("window", c_ulong),
                ("message_type", c_ulong), ("format", c_int), ("l", c_long * 5)]


class SelectionRequest(Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p), ("owner", c_ulong),
                ("requestor", c_ulong), ("selection", c_ulong), ("target", c_ulong), ("property", c_ulong), ("time", c_ulong)]


class Selection(Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p), ("requestor", c_ulong),
                ("selection", c_ulong), ("target", c_ulong), ("property", c_ulong), ("time", c_ulong)]


class Event(Union):
    _fields_ = [("type", c_int), ("client", ClientMessage), ("request", SelectionRequest), ("selection", Selection),
                ("pad", c_long * 24)]


class Image(Structure):
    _fields_ = [("width", c_int), ("height", c_int), ("xoffset", c_int), ("format", c_int), ("data", POINTER(c_ubyte)),
                ("byte_order", c_int), ("bitmap_unit", c_int), ("bitmap_bit_order", c_int), ("bitmap_pad", c_int),
                ("depth", c_int), ("bytes_per_line", c_int), ("bits_per_pixel", c_int)]


# A window may go, or not be there yet, while it is asked for its picture: no reason to end.
ON_ERROR = ctypes.CFUNCTYPE(c_int, c_void_p, c_void_p)(lambda display, error: 0)


def load_library():
    """libX11 with the signatures that are used here; None where it is missing."""
    try:
        x = ctypes.CDLL("libX11.so.6")
    except OSError:
        return None
    x.XOpenDisplay.restype = c_void_p
    x.XDefaultRootWindow.argtypes, x.XDefaultRootWindow.restype = [c_void_p], c_ulong
    x.XInternAtom.argtypes, x.XInternAtom.restype = [c_void_p, c_char_p, c_int], c_ulong
    x.XGetImage.argtypes = [c_void_p, c_ulong, c_int, c_int, c_uint, c_uint, c_ulong, c_int]
    x.XGetImage.restype = POINTER(Image)
    x.XFree.argtypes = [c_void_p]
    x.XGetGeometry.argtypes = [c_void_p, c_ulong, POINTER(c_ulong), POINTER(c_int), POINTER(c_int), POINTER(c_uint),
                               POINTER(c_uint), POINTER(c_uint), POINTER(c_uint)]
    x.XCreateSimpleWindow.argtypes = [c_void_p, c_ulong, c_int, c_int, c_uint, c_uint, c_uint, c_ulong, c_ulong]
    x.XCreateSimpleWindow.restype = c_ulong
    x.XSetSelectionOwner.argtypes = [c_void_p, c_ulong, c_ulong, c_ulong]
    x.XSendEvent.argtypes = [c_void_p, c_ulong, c_int, c_long, POINTER(Event)]
    x.XChangeProperty.argtypes = [c_void_p, c_ulong, c_ulong, c_ulong, c_int, c_int, c_char_p, c_int]
    for name in ("XFlush", "XPending", "XCloseDisplay"):
        getattr(x, name).argtypes = [c_void_p]
    x.XSetErrorHandler.argtypes = [c_void_p]
    x.XSetErrorHandler(ctypes.cast(ON_ERROR, c_void_p))
    x.XNextEvent.argtypes = [c_void_p, POINTER(Event)]
    return x


class Picture:
    """Pixels of a window: row 0 at the top, four bytes each (blue, green, red, unused)."""

    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows

    def mean(self, left=0.0, top=0.0, right=1.0, bottom=1.0):
        """Mean brightness, 0 to 255, of a region given by shares of the sides."""
        total = count = 0
        for row in self.rows[int(top * self.height):int(bottom * self.height)]:
            part = row[4 * int(left * self.width):4 * int(right * self.width)]
            for channel in range(3):
                values = part[channel::4]
                total += sum(values)
                count += len(values)
        return total / max(count, 1)

    def like(self, other):
        """Whether both have one size and differ by less than noise does."""
        return (self.width, self.height) == (other.width, other.height) and self.difference(other) < 0.5

    def difference(self, other, left=0.0, top=0.0, right=1.0, bottom=1.0):
        """Mean absolute difference of the channels over a region, 0 to 255."""
        assert (self.width, self.height) == (other.width, other.height)
        total = count = 0
        for y in range(int(top * self.height), int(bottom * self.height)):
            a = self.rows[y][4 * int(left * self.width):4 * int(right * self.width)]
            b = other.rows[y][4 * int(left * self.width):4 * int(right * self.width)]
            for channel in range(3):
                total += sum(abs(p - q) for p, q in zip(a[channel::4], b[channel::4]))
                count += len(a) // 4
        return total / max(count, 1)


class Screen:
    """One connection to the display that DISPLAY names."""

    def __init__(self):
        self.x = load_library()
        self.display = self.x.XOpenDisplay(None)
        assert self.display, "no display"
        self.root = self.x.XDefaultRootWindow(self.display)

    def atom(self, name):
        return self.x.XInternAtom(self.display, name.encode(), 0)

    def size(self, window):
        root, x, y = c_ulong(), c_int(), c_int()
        width, height, border, depth = c_uint(), c_uint(), c_uint(), c_uint()
        self.x.XGetGeometry(self.display, window, byref(root), byref(x), byref(y), byref(width), byref(height),
                            byref(border), byref(depth))
        return width.value, height.value

    def picture(self, window):
        """What the window shows, or None where it cannot be read."""
        width, height = self.size(window)
        image = self.x.XGetImage(self.display, window, 0, 0, width, height, ALL_PLANES, Z_PIXMAP)
        if not image:
            return None
        line = image.contents.bytes_per_line
        assert image.contents.bits_per_pixel == 32
        data = ctypes.string_at(image.contents.data, line * height)
        self.x.XFree(image.contents.data)
        self.x.XFree(image)
        return Picture(width, height, [data[y * line:y * line + 4 * width] for y in range(height)])

    def send(self, window, message, *values):
        event = Event()
        event.client = ClientMessage(CLIENT_MESSAGE, 0, 1, self.display, window, self.atom(message), 32,
                                     (c_long * 5)(*values))
        self.x.XSendEvent(self.display, window, 0, 0, byref(event))
        self.x.XFlush(self.display)

    def close(self, window):
        """As the cross of a window's frame does."""
        self.send(window, "WM_PROTOCOLS", self.atom("WM_DELETE_WINDOW"), 0)

    def wait_event(self, accepts, seconds=10.0):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            while self.x.XPending(self.display):
                event = Event()
                self.x.XNextEvent(self.display, byref(event))
                if accepts(event):
                    return event
            time.sleep(0.005)
        raise AssertionError("the window did not answer a drop")

    def is_message(self, event, name):
        return event.type == CLIENT_MESSAGE and event.client.message_type == self.atom(name)

    def drop(self, window, path):
        """Drops one file on the middle of the window, as a file manager does (the XDND protocol, version 5)."""
        source = self.x.XCreateSimpleWindow(self.display, self.root, 0, 0, 1, 1, 0, 0, 0)
        uris, selection = self.atom("text/uri-list"), self.atom("XdndSelection")
        self.x.XSetSelectionOwner(self.display, selection, source, 0)
        width, height = self.size(window)
        self.send(window, "XdndEnter", source, XDND_VERSION << 24, uris, 0, 0)
        self.send(window, "XdndPosition", source, 0, (width // 2) << 16 | height // 2, 0, self.atom("XdndActionCopy"))
        self.wait_event(lambda event: self.is_message(event, "XdndStatus"))
        self.send(window, "XdndDrop", source, 0, 0, 0, 0)
        request = self.wait_event(lambda event: event.type == SELECTION_REQUEST).request
        data = (Path(path).absolute().as_uri() + "\r\n").encode()
        self.x.XChangeProperty(self.display, request.requestor, request.property, request.target, 8, 0, data, len(data))
        answer = Event()
        answer.selection = Selection(SELECTION_NOTIFY, 0, 1, self.display, request.requestor, request.selection,
                                     request.target, request.property, request.time)
        self.x.XSendEvent(self.display, request.requestor, 0, 0, byref(answer))
        self.x.XFlush(self.display)
        self.wait_event(lambda event: self.is_message(event, "XdndFinished"))


def xdotool(*words):
    return subprocess.run(["xdotool", *map(str, words)], capture_output=True, text=True, check=False).stdout
