"""Reading beside the kernel's own reader, and sampling: seconds on one core, all figures in one run.

`python benchmarks/reading.py FILE_OR_FOLDER...` prints a table: the kernel's reader (transfer with names, colours and
layers for STEP, all roots for IGES) and `read_part`, turn and turn about, best of five each; the description of all faces;
100,000 samples over the whole part with normals and curvatures, best of three. Files are warm and kernels loaded;
seconds are processor time, so that other work on the machine does not count.
"""

# ruff: noqa: E402
import os

# Other cores would only hide what one costs; numpy counts the cores when it is loaded.
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from OCP.IGESControl import IGESControl_Reader
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDocStd import TDocStd_Document

from cad_io import Part, ReadError, read_part
from cad_io.part.bodies import orient
from cad_io.sample import sample

STEP, IGES = {".step", ".stp"}, {".iges", ".igs"}
READS, SAMPLINGS = 5, 3
SAMPLES, NEAR = 100_000, 0.02  # how many, and how near to that the spacing must come
HEAD = ("file", "faces", "kernel s", "read_part s", "ratio", "faces s", "samples", "sampling s", "samples/s")


def kernel_read(file: Path) -> None:
    if file.suffix.lower() in IGES:
        iges = IGESControl_Reader()
        iges.ReadFile(str(file))
        iges.TransferRoots()
        iges.OneShape()
        return
    step = STEPCAFControl_Reader()
    step.SetColorMode(True)
    step.SetNameMode(True)
    step.SetLayerMode(True)
    step.ReadFile(str(file))
    step.Transfer(TDocStd_Document(TCollection_ExtendedString("XmlXCAF")))


def seconds(job: Callable[[], Any]) -> float:
    began = time.process_time()
    job()
    return time.process_time() - began


def sampling(part: Part) -> tuple[int, float]:
    """How many samples a run made, and its seconds; (0, 0) where nothing can be sampled."""
    orientation = orient(part)
    judged = [info for info in part.faces if info.unjudged is None]
    numbers = [info.number for info in judged]
    if not judged:
        return 0, 0.0
    spacing = (sum(info.area for info in judged) / SAMPLES) ** 0.5
    for _ in range(6):
        count = len(sample(part, orientation, spacing=spacing, faces=numbers).point)
        if abs(count / SAMPLES - 1) < NEAR:
            break
        spacing *= (count / SAMPLES) ** 0.5
    best = min(seconds(lambda: sample(part, orientation, spacing=spacing, faces=numbers)) for _ in range(SAMPLINGS))
    return count, best


def row(file: Path) -> list[str]:
    try:
        part = read_part(file)
    except ReadError as error:
        return [file.name, "", "", "", "", "", "", "", str(error).removeprefix(f"{file}: ")]
    turns = [(seconds(lambda: kernel_read(file)), seconds(lambda: read_part(file))) for _ in range(READS)]
    kernel, ours = (min(turn) for turn in zip(*turns, strict=True))
    describe = seconds(lambda: part.faces)
    count, took = sampling(part)
    return [
        file.name, str(len(part.faces)), f"{kernel:.3f}", f"{ours:.3f}", f"{ours / kernel:.2f}", f"{describe:.3f}",
        str(count), f"{took:.2f}", f"{count / took:.0f}" if count else "",
    ]  # fmt: skip


def main(*given: str) -> None:
    files = [f for path in map(Path, given) for f in (sorted(path.rglob("*")) if path.is_dir() else [path])]
    for cells in (HEAD, ["---"] * len(HEAD)):
        print("| " + " | ".join(cells) + " |")
    for file in files:
        if file.suffix.lower() in STEP | IGES:
            print("| " + " | ".join(row(file)) + " |", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
