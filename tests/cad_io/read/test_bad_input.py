"""Files meant to hurt: each is refused in one line, with its cause, in little time and memory."""

import os
import re
import time
import tracemalloc
import zipfile

import numpy as np
import pytest

from cad_io import ReadError, read_part
from cad_io.read.sniff import load
from plan_cutters_base.workers.supervise import _Watch
from tests.support.commands import assert_one_line, leftovers
from tests.support.forked import run
from tests.support.places import SAMPLES

HEADER = (
    b"ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
    b"FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
)
END = b"ENDSEC;\nEND-ISO-10303-21;\n"
GARBAGE = np.random.default_rng(1).bytes(10_000_000)
START = b"%-72sS      1\n" % b"a part"


def sparse(file, start=b"", size=1 << 30):
    with file.open("wb") as stream:
        stream.write(start)
        stream.truncate(size)


def bomb(file):
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("part.step", "w") as inside:
        for _ in range(50):
            inside.write(bytes(1 << 20))


@pytest.mark.parametrize(
    ("name", "make", "match"),
    [
        ("a.step", sparse, "does not start as STEP"),
        ("a.igs", sparse, "does not start as IGES"),
        ("a.step", bomb, "zip archive"),
        ("a.step", os.mkfifo, "a pipe or a device"),
        ("a.step", lambda f: f.symlink_to("/dev/zero"), "a pipe or a device"),
        ("a.step", lambda f: f.write_bytes(b"/**/" * 2_500_000), "does not start as STEP"),
        ("a.step", lambda f: f.write_bytes(b"/*" * 5_000_000), "does not start as STEP"),
        ("a.step", lambda f: f.write_bytes(b" " * 10_000_000), "nothing but blanks"),
        ("a.step", lambda f: f.write_bytes(b"x" * 10_000_000), "does not start as STEP"),
        ("a" * 300 + ".step", lambda f: None, "cannot be read"),
        ("a\0.step", lambda f: None, "cannot be read"),
    ],
    ids=["sparse", "sparse iges", "zip bomb", "pipe", "device", "comments", "open comments", "blanks", "one line",
         "long name", "name with a zero"],
)  # fmt: skip
def test_what_is_no_cad_file_is_not_read_to_its_end(tmp_path, name, make, match):
    make(tmp_path / name)
    tracemalloc.start()
    began = time.process_time()
    try:
        with pytest.raises(ReadError, match=match):
            load(str(tmp_path / name))
        assert tracemalloc.get_traced_memory()[1] < 1e6
    finally:
        tracemalloc.stop()
    assert time.process_time() - began < 1


@pytest.mark.slow("reads a long file", only=("garbage",))
@pytest.mark.parametrize(
    ("name", "content", "match"),
    [
        ("a.step", HEADER + GARBAGE, "cut off"),
        ("a.step", HEADER + b"#1=CARTESIAN_POINT('',(" + b"0.," * 3_000_000 + b"0.));\n" + END, "no shape"),
        ("a.step", HEADER + b"#1=CARTESIAN_POINT('" + b"a" * 10_000_000 + b"',(0.,0.,0.));\n" + END, "syntax"),
        ("a.step", HEADER + b"#1=garbage((((''''  ,, ;\n" * 2000, "cut off"),
        ("a.igs", START + b"1" * 10_000_000, "no terminate record"),
        ("a.igs", START + b"\n" * 3_000_000, "no terminate record"),
        ("a.igs", START + GARBAGE, "terminate record|could be read|not valid IGES"),
    ],
    ids=["garbage", "one list", "one string", "one fault after another", "one record", "empty records", "iges garbage"],
)  # fmt: skip
def test_garbage_behind_a_good_start(tmp_path, name, content, match):
    (tmp_path / name).write_bytes(content)
    began = time.process_time()
    with pytest.raises(ReadError, match=match) as caught:
        read_part(tmp_path / name)
    assert str(caught.value).startswith(str(tmp_path / name))
    assert time.process_time() - began < 5


@pytest.mark.parametrize("number", ["1.E12", "1.E300", "-1.E99"])
def test_coordinates_without_digits_left_are_refused(tmp_path, number):
    text = (SAMPLES / "v_groove.step").read_text()
    (tmp_path / "a.step").write_text(re.sub(r"(CARTESIAN_POINT\('',\()[^,]*", rf"\g<1>{number}", text))
    with pytest.raises(ReadError, match="from the origin"):
        read_part(tmp_path / "a.step")


@pytest.mark.slow("nests so deep that the kernel crashes", only=("nested",))
@pytest.mark.parametrize(
    ("name", "content", "cause"),
    [
        # A parser that calls itself: it runs out of stack, or is caught by its own limit.
        ("nested.step", HEADER + b"#1=A(" + b"(" * 100_000 + b")" * 100_000 + b");\n" + END, "export it again"),
        # The kernel's BREP reader prints past Python.
        ("loud.brep", b"CASCADE Topology V1, (c) Matra-Datavision\nLocations 3\nhelp\n", "BREP"),
    ],
)
def test_crashes_and_chatter_of_the_kernel_are_one_line(tmp_path, name, content, cause):
    (tmp_path / name).write_bytes(content)
    assert_one_line(run(name, "--cutter", "R3L40", cwd=tmp_path, timeout=60), 3, name, cause)
    assert leftovers(tmp_path, name) == []


def test_every_stage_of_the_kernel_has_a_limit():
    here, there = os.pipe()
    watch = _Watch(read_timeout=0.01)
    watch.pipe = here
    late = {}
    for stage in ("start", "read", "tessellate", "R3L40", "write"):
        os.write(there, f"stage {stage}\n".encode())
        watch.listen(0.0)
        assert not watch.late()
        time.sleep(0.1)
        late[stage] = watch.late()
    os.close(here)
    os.close(there)
    assert late == {"start": False, "read": True, "tessellate": True, "R3L40": False, "write": True}
