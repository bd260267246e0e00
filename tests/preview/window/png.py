"""Reads PNG files of 8 bits a channel as the tests need them: how much a row of pixels differs within itself."""
import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # by colour type


def paeth(left, above, corner):
    guess = left + above - corner
    return min((left, above, corner), key=lambda value: abs(guess - value))


def rows_of(path):
    """The rows' bytes, row 0 at the top, and the bytes a pixel."""
    data = path.read_bytes()
    assert data[:8] == SIGNATURE, f"{path} is no PNG"
    at, packed, header = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        at += size + 12
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
    width, height, bits, colour = header[:4]
    assert bits == 8, f"{path} has {bits} bits a channel"
    step = CHANNELS[colour]
    flat, rows = zlib.decompress(packed), []
    before = bytearray(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        kind, row = flat[start], bytearray(flat[start + 1:start + 1 + width * step])
        for i in range(len(row)):
            left = row[i - step] if i >= step else 0
            corner = before[i - step] if i >= step else 0
            row[i] = (row[i] + (0, left, before[i], (left + before[i]) // 2, paeth(left, before[i], corner))[kind]) & 255
        rows.append(row)
        before = row
    return rows, step


def spread_along_rows(path):
    """The largest difference within a row, 0 to 255: 0 for a backdrop alone, whose rows are even."""
    rows, step = rows_of(path)
    return max(max(row[0::step]) - min(row[0::step]) for row in rows)
