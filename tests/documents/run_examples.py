"""Runs the examples of the documents, as a reader would type them, and compares what they print.

An example is an indented block with lines that begin with `$ `. The other lines of the block are what the command
above them prints. `...` stands for any lines. Words must be the same. Numbers may differ by two units of their last
digit, and times may differ by any amount. All examples of a page run in one folder, which holds a copy of scenes/. A
page is run as a whole, or in long runs alone where it says <!-- examples: long -->.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field

import numpy as np

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
TIME_UNITS = ("ms", "s", "min", "frames/s")
LONG_MARK = "<!-- examples: long -->"
FIGURES_PAGE = "figures.md"
TIMED_FIGURES = {"tradeoff.png"}  # show times, and are made by hand
MEAN_DIFFERENCE = 1.0  # of 255: last digits of channels differ from processor to processor


@dataclass
class Example:
    line: int  # of the page, from 1
    command: str
    printed: list[str] = field(default_factory=list)


def indented(line: str) -> bool:
    return line.startswith("    ")


def examples_of(page: str) -> list[Example]:
    """The examples in their order; a command goes on in the next line behind a backslash."""
    found: list[Example] = []
    open_example = False
    for number, line in enumerate(page.splitlines(), 1):
        text = line[4:].rstrip()
        if indented(line) and text.startswith("$ "):
            found.append(Example(number, text[2:]))
            open_example = True
        elif open_example and indented(line) and found[-1].command.endswith("\\"):
            found[-1].command = found[-1].command[:-1] + text.strip()
        elif open_example and indented(line):
            found[-1].printed.append(text)
        else:
            open_example = open_example and not line.strip()
    return found


def last_digit(number: str) -> float:
    """The size of a unit of the last digit that is written."""
    mantissa, _, exponent = number.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)


def same_number(expected: str, found: str) -> bool:
    unit = max(last_digit(expected), last_digit(found))
    return abs(float(expected) - float(found)) <= 2.001 * unit


def same_line(expected: str, found: str) -> bool:
    """Whether both say the same, but for spaces, times, and the last digits of numbers."""
    expected, found = " ".join(expected.split()), " ".join(found.split())
    if NUMBER.sub("#", expected) != NUMBER.sub("#", found):
        return False
    for a, b in zip(NUMBER.finditer(expected), NUMBER.finditer(found)):
        unit = expected[a.end() :].lstrip().split(" ")[0].rstrip(",.;:")
        if unit not in TIME_UNITS and not same_number(a.group(), b.group()):
            return False
    return True


def first_difference(expected: list[str], found: list[str]) -> str | None:
    """What the output lacks: the expected lines in their order, next to each other but where `...` stands."""
    at, anywhere = 0, False
    for line in expected:
        if line.strip() == "...":
            anywhere = True
            continue
        if line.strip() == "":
            continue
        while at < len(found) and (not found[at].strip() or (anywhere and not same_line(line, found[at]))):
            at += 1
        if at == len(found):
            return f"expected the line {line!r}, and there is none left"
        if not same_line(line, found[at]):
            return f"expected the line {line!r}, found {found[at]!r}"
        at, anywhere = at + 1, False
    return None


def prepare(folder: pathlib.Path, source: pathlib.Path, program: pathlib.Path) -> dict[str, str]:
    """Fills the folder in which a page's examples run, and returns their environment."""
    shutil.copytree(source / "scenes", folder / "scenes")
    (folder / "figures").mkdir()
    tools = folder / ".tools"
    tools.mkdir()
    (tools / "pmdsim").symlink_to(program)
    (folder / "do").write_text('#!/bin/sh\n[ "$1" = run ] && shift && exec pmdsim "$@"\nexit 2\n')
    (folder / "do").chmod(0o755)
    python = source / "host" / "python"
    return {**os.environ, "PATH": f"{tools}:/usr/bin:/bin", "PYTHONPATH": str(python)}


def run_page(page: pathlib.Path, folder: pathlib.Path, environment: dict[str, str]) -> list[str]:
    """Runs the examples and returns what is wrong, a line for each."""
    wrong = []
    for example in examples_of(page.read_text(encoding="utf-8")):
        place = f"{page.name}:{example.line}"
        done = subprocess.run(
            ["bash", "-c", example.command],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=900,
        )
        print(f"{place}: {example.command}: exit code {done.returncode}")
        difference = first_difference(example.printed, done.stdout.splitlines())
        if difference:
            wrong.append(f"{place}: {example.command}: {difference}; printed was:\n{done.stdout}")
        elif done.returncode != 0 and "error:" not in " ".join(example.printed):
            wrong.append(f"{place}: {example.command}: exit code {done.returncode}: {done.stdout}")
    return wrong


def picture(file: pathlib.Path) -> np.ndarray:
    from PIL import Image  # which pages without pictures do not need

    return np.asarray(Image.open(file).convert("RGB"), dtype=float)


def wrong_pictures(made: pathlib.Path, kept: pathlib.Path) -> list[str]:
    """A line for each picture of `kept` that is not as it was made just now."""
    names = {file.name for file in kept.glob("*.png")} - TIMED_FIGURES
    wrong = [f"{name}: not made by {FIGURES_PAGE}" for name in sorted(names - {file.name for file in made.iterdir()})]
    for file in sorted(made.iterdir()):
        if not (kept / file.name).exists():
            wrong.append(f"{file.name}: not in {kept}")
            continue
        a, b = picture(file), picture(kept / file.name)
        if a.shape != b.shape or np.abs(a - b).mean() > MEAN_DIFFERENCE:
            wrong.append(f"{file.name}: is not the picture that its command makes")
    return wrong


def is_long(page: pathlib.Path) -> bool:
    return LONG_MARK in page.read_text(encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--long", action="store_true", help="the pages that take long, and no others")
    parser.add_argument("--keep", type=pathlib.Path, help="copy the pictures that the examples make there")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    source = arguments.source.resolve()
    pages = arguments.pages or [source / "README.md", *sorted((source / "docs").glob("*.md"))]
    wrong, count = [], 0
    for page in pages:
        found = examples_of(page.read_text(encoding="utf-8"))
        if not found or (not arguments.pages and is_long(page) != arguments.long):
            continue
        count += len(found)
        with tempfile.TemporaryDirectory(prefix="pmdsim_examples.") as scratch:
            folder = pathlib.Path(scratch)
            environment = prepare(folder, source, arguments.program.resolve())
            wrong += run_page(page, folder, environment)
            if arguments.keep:
                shutil.copytree(folder / "figures", arguments.keep, dirs_exist_ok=True)
            elif page.name == FIGURES_PAGE:
                wrong += wrong_pictures(folder / "figures", source / "scenes" / "figures")
    print("\n".join(wrong), file=sys.stderr)
    print(f"{count} examples run, {len(wrong)} of them wrong")
    return 1 if wrong or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
