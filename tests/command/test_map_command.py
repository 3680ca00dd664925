"""`plan-cutters-map`: the table, the pictures and the errors; the picture's intervals against the map's own."""

import json
import math
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from cad_io import read_part
from cad_io.errors import SampleError
from cad_io.sample import nearest
from plan_cutters import posture_map
from plan_cutters.command import map as of_a_point
from plan_cutters.domain.posture import without
from plan_cutters.plan_file.reasons import CAUSES, NO_CONTACT
from plan_cutters.report.drawing.posture_map import DPI, figure, fitting, forbidden, write
from tests.support.forked import run as run_copied
from tests.support.schemas import valid

GROOVE = "samples/v_groove.step"


def run(capsys, *words):
    with pytest.raises(SystemExit) as ended:
        of_a_point.main(list(words))
    out, err = capsys.readouterr()
    return ended.value.code, out, err


@pytest.mark.slow("runs whole commands")
def test_the_seed_s_first_example(capsys, tmp_path):
    """Free tilts at the bottom of the groove between the closed forms: 27.6 to 61.3 deg at rotation 0, fewer beside it."""
    out = tmp_path / "map.png"
    code, text, err = run(capsys, GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--rotation", "0:40", "--rotation-step", "20",
                          "--tolerance", "0", "-o", str(out), "--json", "-")  # fmt: skip
    assert (code, err) == (0, "")
    found = valid("map", json.loads(text))
    assert found["face"] == "F2"
    assert found["off_mm"] == pytest.approx(0.0, abs=1e-9)
    ((low, high),) = found["rotations"][0]["free"]
    assert low == pytest.approx(27.5994, abs=0.05)
    assert high == pytest.approx(61.3466, abs=0.05)
    assert found["rotations"][1]["local_gouge"] == pytest.approx(
        math.degrees(math.asin(8 / 5 * math.sin(math.radians(20)) ** 2)), abs=0.01
    )
    assert out.stat().st_size > 10_000


def test_the_table_and_both_pictures(capsys, tmp_path, monkeypatch):
    part = os.path.abspath(GROOVE)
    monkeypatch.chdir(tmp_path)
    words = [part, "--at", "0,0,0.3", "--cutter", "R8L90", "--rotation", "0:90", "--rotation-step", "30"]
    code, out, err = run(capsys, *words)
    assert (code, err) == (0, "")
    assert "Flat end D16 x 90 (R8L90) at (0, 0, 0) on F2 of v_groove.step" in out
    assert "0.3 mm off" in out
    assert max(map(len, [line for line in out.splitlines() if "│" in line])) <= 80
    row = next(line for line in out.splitlines() if line.startswith("│        0 │"))
    low, high = (float(word) for word in row.split("│")[2].split(" to "))
    assert low == pytest.approx(27.6, abs=0.1)
    assert high == pytest.approx(61.4, abs=0.1)  # the tolerance lets the shaft go a little further
    names = ["v_groove-map.png", "v_groove-map.svg"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    first = [(tmp_path / name).read_bytes() for name in names]
    assert b"<svg" in first[1]
    run(capsys, *words, "--quiet")
    assert [(tmp_path / name).read_bytes() for name in names] == first


def test_colours_stand_where_the_map_says(capsys, tmp_path):
    out = tmp_path / "map.png"
    words = ["--rotation", "0:350", "--rotation-step", "10", "--tilt", "0:60"]
    assert run(capsys, GROOVE, "--at", "0,0,0", "--cutter", "R8L90", *words, "-o", str(out), "--quiet")[0] == 0
    with Image.open(out) as image:
        pixels = np.asarray(image.convert("RGB"), float)
    free = np.abs(pixels - [0, 0x9E, 0x73]).max(axis=-1) < 3
    _, width, _ = pixels.shape
    plot = free[:, int(0.07 * width) : int(0.78 * width)]
    found = posture_map(GROOVE, point=(0, 0, 0), cutter="R8L90", rotations=np.radians(np.arange(0, 360, 10)),
                        tilt=(0.0, math.radians(60)))  # fmt: skip
    share = sum(float(np.diff(each).sum()) for each in found.free) / (36 * math.radians(60))
    area = 0.70 * width * 3.45 * 150
    assert plot.sum() / area == pytest.approx(share, abs=0.02)


def test_every_tilt_has_one_colour():
    found = posture_map(
        GROOVE,
        point=nearest(read_part(GROOVE), (3, 5, 0.988))[0],
        cutter="R6L40F8S5",
        rotations=np.linspace(0, 6, 7),
        machine="tilt:50",
    )
    shares = forbidden(found, 0.0, math.pi / 2)
    assert set(shares) == {*CAUSES, NO_CONTACT.code, "undecided", "other"}
    rng = np.random.default_rng(0)
    causes = set()
    for i in range(len(found.rotations)):
        for tilt in rng.uniform(0, math.pi / 2, 200):
            held = [name for name, each in {**shares, "free": found.free}.items()
                    if any(low < tilt < high for low, high in each[i])]  # fmt: skip
            assert len(held) == 1, (i, tilt, held)
            causes.add(held[0])
            if held[0] not in ("free", "undecided", "other", "local_gouge"):
                assert any(low <= tilt <= high for low, high in getattr(found, held[0])[i])
    assert {"free", "axis_limit"} <= causes


def test_what_is_left_of_intervals():
    rng = np.random.default_rng(1)
    for _ in range(50):
        one, two = (np.sort(rng.uniform(0, 9, 2 * k)).reshape(-1, 2) for k in rng.integers(0, 4, 2))
        left = without(one, two)
        for x in rng.uniform(0, 9, 40):
            inside = [bool(((each[:, 0] < x) & (x < each[:, 1])).any()) for each in (one, two, left)]
            assert inside[2] == (inside[0] and not inside[1])


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["nix.step", "--at", "0,0,0", "--cutter", "R8L90"], 3, "nix.step: no such file"),
        ([GROOVE, "--at", "0,0,90", "--cutter", "R8L90"], 2, "mm from the part: the nearest point of a face is (-24.15"),
        ([GROOVE, "--at", "0,0", "--cutter", "R8L90"], 2, "--at '0,0' is not 3 numbers"),
        ([GROOVE, "--at", "0,0,nan", "--cutter", "R8L90"], 2, "is not 3 numbers"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "Q8"], 2, "cutter 'Q8' is not of the form"),
        ([GROOVE, "--at", "0,0,0"], 2, "--cutter"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "-o", "map.pdf"], 2, "written as .png or .svg"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "-o", "no/such/map.png"], 2, "no such folder"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--machine", "mill"], 2, "mill"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--tilt", "50:10"], 2, "must run upwards"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--within", "-1"], 2, "--within"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--allowance", "nan"], 2, "allowance must be a number"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--setup", "nix.toml"], 2, "nix.toml: cannot be read"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--machine", "3-axis"], 2, "fewer than two rotary axes"),
        ([GROOVE, "--at", "0,0,0", "--cutter", "X", "--cutters", "samples/shop.toml"], 2, "no tool is called 'X'"),
    ],
)
def test_mistakes_are_one_line(capsys, words, code, says):
    found, out, err = run(capsys, *words)
    assert (found, out) == (code, "")
    assert err.startswith("plan-cutters map: ")
    assert err.count("\n") == 1
    assert says in err


def test_nothing_free_is_another_exit_code(capsys, tmp_path):
    words = ["--at", "0,0,0", "--cutter", "R8L90", "-o", str(tmp_path / "m.svg")]
    code, out, _ = run(capsys, GROOVE, *words, "--rotation", "90:90", "--tilt", "0:60")
    assert code == 1
    assert "none" in out


def test_a_tool_of_a_library_and_its_name(capsys, tmp_path):
    from plan_cutters.library import read_library

    tool = read_library("samples/shop.toml")[0]
    words = ["--at", "0,60,0", "--rotation", "0:0", "-o", str(tmp_path / "m.svg"), "--json", "-"]
    for name in {tool.id, tool.name} - {""}:
        _, out, err = run(capsys, GROOVE, "--cutters", "samples/shop.toml", "--cutter", name, *words)
        assert err == ""
        assert json.loads(out)["cutter"] == tool.id


def test_a_setup_file_says_how_the_part_stands(capsys, tmp_path):
    """Its X decides which of the tilts across it a trunnion holds, and its fixtures are in the way."""
    (tmp_path / "setup.toml").write_text('unit = "mm"\naxis = [0, 0, 1]\nx = [0, 1, 0]\nfixtures = ["box:4,4,40@14,0,30"]\n')
    (tmp_path / "mill.toml").write_text(
        'format = "plan-cutters-machine"\nversion = 1\nname = "mill"\nunits = { length = "mm", angle = "deg" }\n'
        'sign = "tool-relative"\n'
        '[[part_chain]]\naxis = "A"\ntype = "rotary"\ndirection = [1, 0, 0]\nlimits = [-60, 60]\n'
        '[[part_chain]]\naxis = "C"\ntype = "rotary"\ndirection = [0, 0, 1]\nlimits = [-10, 10]\n'
        '[[tool_chain]]\naxis = "Z"\ntype = "linear"\ndirection = [0, 0, 1]\n'
    )
    words = [GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--rotation-step", "45", "--machine", str(tmp_path / "mill.toml"),
             "-o", str(tmp_path / "m.svg"), "--json", "-"]  # fmt: skip
    free = []
    for setup in ("0,0,1", str(tmp_path / "setup.toml")):
        code, out, err = run(capsys, *words, "--setup", setup)
        assert err == ""
        free.append([sum(high - low for low, high in each["free"]) for each in json.loads(out)["rotations"]])
        assert (code == 0) == (sum(free[-1]) > 0)
    # The groove leaves tilts about its own line, y, alone; the fixture stands on the side of +x.
    assert sum(free[0]) == 0
    assert np.flatnonzero(free[1]).tolist() == [0, 4]
    assert 0 < free[1][0] < 5 < 30 < free[1][4]


def test_names_are_no_formulas_and_all_words_stay_on_the_sheet(capsys, tmp_path):
    part = tmp_path / ("a$x_{1$^\\frac$ \u4e2d" + "W" * 150 + ".step")
    shutil.copy(GROOVE, part)
    out = tmp_path / "map.png"
    code, text, err = run(capsys, str(part), "--at", "0.123456,5.123456,0.3", "--cutter", "R8L90", "--rotation", "0:40", "-o",
                          str(out), "-o", str(tmp_path / "map.svg"))  # fmt: skip
    assert (code, err) == (0, "")
    assert "a$x_{1$^" in text
    with Image.open(out) as image:
        pixels = np.asarray(image.convert("L"))
    inked = pixels < 200
    assert not inked[:, -30:].any()
    assert not inked[-10:].any()
    assert not inked[:10].any()


def test_lines_are_as_wide_as_their_letters():
    for text in ("iiii " * 60, "WWWW " * 60, "M" * 300, "1 " + "W" * 200, ""):
        lines = fitting(text, 8, 3.0)
        assert "".join(lines).replace(" ", "") == text.replace(" ", "")
        sheet = figure(4.0, 3.0)
        write(sheet, lines, (0.5, 2.9), 8)
        (drawn,) = sheet.texts
        box = drawn.get_window_extent(FigureCanvasAgg(sheet).get_renderer())
        assert box.width <= 3.0 * DPI
    assert len(fitting("iiii " * 60, 8, 3.0)) < len(fitting("WWWW " * 60, 8, 3.0))


@pytest.mark.slow("starts commands and ends them on the way")
def test_a_reader_that_goes_is_no_verdict():
    done = subprocess.run(
        f"{sys.executable} -m plan_cutters map {GROOVE} --at 0,0,0 --cutter R8L90 -o $(mktemp -d)/m.png | true; "
        "echo ${PIPESTATUS[0]}",
        shell=True, executable="/bin/bash", capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.stdout.strip(), done.stderr) == ("141", "")


def test_as_a_program(tmp_path):
    done = run_copied("map", GROOVE, "--at", "0,0,0", "--cutter", "R8L90", "--rotation", "0:0", "-o", tmp_path / "m.png")
    assert (done.returncode, done.stderr) == (0, "")
    assert "to 61.4" in done.stdout


def test_the_nearest_point_is_nearest():
    part = read_part(GROOVE)
    rng = np.random.default_rng(3)
    faces = [part.surface(f.number) for f in part.faces]
    assert len(faces) == 3
    for place in rng.uniform(-30, 30, (6, 3)):
        foot, off = nearest(part, place)
        assert np.linalg.norm(foot - place) == pytest.approx(off)
        assert nearest(part, foot)[1] == pytest.approx(0.0, abs=1e-6)
        other, far = nearest(part, place, ignore={1, 2})
        assert far >= off - 1e-9
        assert np.isfinite(other).all()
    with pytest.raises(SampleError, match="no face"):
        nearest(part, (0, 0, 0), ignore={1, 2, 3})
    with pytest.raises(SampleError, match="three finite"):
        nearest(part, (0, 0, math.nan))
