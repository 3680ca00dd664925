"""IGES states its unit twice and a scale besides: what disagrees is told with both sizes, and what is unknown is never silent."""

import re

import pytest
from OCP.IGESControl import IGESControl_Writer

from cad_io import read_part
from cad_io.read.iges import FLAGS, unit_of
from cad_io.units import UNITS
from plan_cutters import plan
from plan_cutters.plan_file.words.names import as_fields
from plan_cutters.plan_file.words.text import text_of
from plan_cutters.report.page.write import page
from tests.support.cad_parts import box

SIZE = (30.0, 20.0, 10.0)
STATED = re.compile(rb",1\.,2,2HMM,")


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    path = tmp_path_factory.mktemp("iges") / "plain.igs"
    writer = IGESControl_Writer("MM", 1)
    writer.AddShape(box(*SIZE))
    writer.ComputeModel()
    writer.Write(str(path))
    return path.read_bytes()


@pytest.fixture
def stated(plain, tmp_path):
    """A file whose numbers are 30, 20 and 10, with what its global section says of their unit."""

    def write(flag, name, scale="1."):
        lines = plain.splitlines(keepends=True)
        k = next(k for k, line in enumerate(lines) if line[72:73] == b"G" and STATED.search(line))
        text = f",{scale},{flag},{f'{len(name)}H{name}' if name else ''},".encode()
        body = STATED.sub(text, lines[k][:72].rstrip())
        assert len(body) <= 72
        lines[k] = body.ljust(72) + lines[k][72:]
        path = tmp_path / "stated.igs"
        path.write_bytes(b"".join(lines))
        return path

    return write


def sizes(factor):
    return pytest.approx([factor * length for length in SIZE], rel=1e-6)


@pytest.mark.parametrize("flag", ["1", "2", "10"])
@pytest.mark.parametrize("name", ["MM", "INCH", "CM"])
def test_the_flag_decides_and_the_name_is_a_doubt_where_it_disagrees(stated, flag, name):
    by_flag = UNITS[FLAGS[int(flag)]]
    by_name = UNITS[{"MM": "mm", "INCH": "in", "CM": "cm"}[name]]
    part = read_part(stated(flag, name))
    assert part.size == sizes(by_flag)
    if by_flag == by_name:
        assert part.unit_doubt == ""
        assert part.warnings == ()
        return
    (reading,) = part.unit_readings
    assert reading.cause == "disagree"
    # The unit that is offered gives the size that is told.
    assert read_part(stated(flag, name), unit=reading.unit).size == sizes(by_flag * reading.times)
    assert reading.times == pytest.approx(by_name / by_flag)
    assert len(part.warnings) == 1, "the kernel's own words on it are not told, too"


@pytest.mark.parametrize(
    ("flag", "name", "factor", "sure"),
    [
        ("3", "MM", 1.0, True),
        ("3", "cm", 10.0, True),  # the kernel takes mm
        ("3", "INCHES", 25.4, True),
        ("3", "FOO", 1.0, False),
        ("3", "", 1.0, False),  # the kernel takes inches
        ("2", "", 1.0, True),
        ("2", "MILLIMETERS", 1.0, True),
        ("2", "FOO", 1.0, False),
        ("12", "IN", 25.4, False),
        ("12", "", 1.0, False),
        ("-1", "MM", 1.0, False),
        ("0", "MM", 1.0, False),
        ("", "MM", 1.0, False),
        ("", "", 25.4, False),  # the standard's default
    ],
)
def test_what_is_not_known_is_a_doubt(stated, flag, name, factor, sure):
    part = read_part(stated(flag, name))
    assert part.size == sizes(factor)
    assert (part.unit_doubt == "") == sure
    assert read_part(stated(flag, name), unit="mm").unit_doubt == ""


@pytest.mark.parametrize("scale", ["2.", "0.125", "25.4", "1D1"])
def test_lengths_are_divided_by_the_model_space_scale_and_that_is_told(stated, scale):
    number = float(scale.replace("D", "E"))
    part = read_part(stated("2", "MM", scale))
    assert part.size == sizes(1.0 / number)
    (reading,) = part.unit_readings
    assert (reading.cause, reading.times) == ("scale", pytest.approx(number))
    as_written = read_part(stated("2", "MM", scale), unit=reading.unit)
    assert as_written.size == sizes(1.0)
    assert as_written.unit_doubt == ""


@pytest.mark.parametrize("scale", ["0.", "-1.", "x", "1E999"])
def test_a_scale_that_means_nothing_is_a_doubt(stated, scale):
    part = read_part(stated("2", "MM", scale))
    assert part.size == sizes(1.0)
    assert "model space scale" in part.unit_doubt


def test_both_sizes_and_the_way_to_decide_stand_above_the_process(stated):
    result = plan(read_part(stated("1", "MM")), cutters=["D6L60"], faces="F6", grid=4, area_budget=0)
    (line,) = result.plan.process.doubts
    assert "762 x 508 x 254 mm by its flag" in line
    assert "30 x 20 x 10 mm by its name" in line
    assert "--unit mm" in line
    lines = " ".join(text_of(result.plan).lines)
    assert lines.startswith(line[:60])
    assert "unit = mm takes the latter." in lines, "it is not cut"
    assert as_fields(line).replace('"', "&#34;") in page(result).decode()


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b";",
        b"1H",
        b"99999999999999H,",
        b"1H,,1H;,,,,,,,,,,,1.,2,2HMM;",
        b"1H/,1H;/3Ha/b/////////1.2/2/",
        b"\xff\xfe" * 40,
        b",,,,,,,,,,,,1.,2,9HMM;",
    ],
)
def test_a_damaged_section_raises_nothing(text):
    assert unit_of([text]).scale > 0.0


def test_strings_are_counted_and_may_hold_the_delimiters():
    assert unit_of([b"1H/,1H;/3H/;/////////////"[:24], b"2.5/6/1HM;"]).unit in {"m", "in", "mm"}
    assert unit_of([b",,5Ha,b;c,,,,,,,,,,2.,10,2HCM;"]) == unit_of([b",,,,,,,,,,,,2.,10,2HCM;"])
    assert unit_of([b"1H/,1H!,3H/!/////////////"])
