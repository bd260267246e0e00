#!/usr/bin/env python3
"""Runs one table of case_table.py: each case is a command line, its exit code and what it must say.

usage: cases.py bake|preview|tolerances
Also holds every case that fails to leaving no file behind. Depends on programs.py, damaged.py, case_table.py.
"""
import shlex
import sys
import tempfile
from pathlib import Path

import case_table
import damaged
import programs

PROGRAMS = {"bake": programs.BAKE, "preview": programs.PREVIEW, "tolerances": programs.TOLERANCES}


def files_in(folder):
    return {str(file.relative_to(folder)) for file in Path(folder).rglob("*")}


def faults_of(case, folder):
    """Runs one case in `folder`; returns what was wrong as sentences, and what the program said."""
    if case.recipe is not None:
        (folder / "pipeline.yaml").write_text(case.recipe)
    for file, text in case.files.items():
        (folder / file).write_text(text)
    before = files_in(folder)
    name, *arguments = shlex.split(case.command)
    done = programs.run([PROGRAMS[name], *arguments], folder, case.file_bytes)
    faults = []
    if done.returncode not in case.exits:
        faults.append(f"exit {done.returncode} instead of {' or '.join(map(str, case.exits))}")
    for stream, text, pieces in (("stderr", done.stderr, case.stderr), ("stdout", done.stdout, case.stdout)):
        faults += [f"{stream} lacks {piece!r}" for piece in pieces if piece not in text]
    left = {file for file in files_in(folder) - before if (folder / file).is_file()}
    if done.returncode != 0 and left:
        faults.append(f"left behind: {', '.join(sorted(left))}")
    return faults, done.stdout + done.stderr


def main():
    failed = left_out = 0
    table = case_table.TABLES[sys.argv[1]]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        missing = damaged.make_files(folder)
        for case in table:
            if any(file in case.command for file in missing):
                print(f"left out  {case.command}: python3-openvdb is missing")
                left_out += 1
                continue
            faults, said = faults_of(case, folder)
            print(f"{'FAILED' if faults else 'passed'}    {case.command}    {case.note}")
            if faults:
                failed += 1
                print("\n".join(f"          {fault}" for fault in faults) + f"\n--- it said:\n{said}---")
    print(f"{len(table) - failed - left_out} cases passed, {failed} failed, {left_out} left out")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
