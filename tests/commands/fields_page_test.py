#!/usr/bin/env python3
"""docs/fields.md and its pictures are what `nodes --markdown` writes.

usage: fields_page_test.py DOCS_FOLDER
Depends on programs.py.
"""
import sys
import tempfile
from pathlib import Path

import programs


def main():
    docs = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        programs.run_well([programs.BAKE, "nodes", "--markdown", "page"], folder)
        written = {file.relative_to(folder + "/page"): file.read_bytes() for file in Path(folder, "page").rglob("*.*")}
    kept = {Path("fields.md")} | {file.relative_to(docs) for file in (docs / "images" / "fields").glob("*.png")}
    faults = [f"{file}: only in one of both" for file in written.keys() ^ kept]
    faults += [f"{file}: not what is written" for file in written.keys() & kept if written[file] != (docs / file).read_bytes()]
    if faults:
        faults.append("write them anew: nephele-bake nodes --markdown docs")
    print(f"{len(written)} files", *faults, sep="\n")
    return 1 if faults or len(written) < 2 else 0


if __name__ == "__main__":
    sys.exit(main())
