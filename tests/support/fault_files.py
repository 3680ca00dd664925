"""Good STEP files made faulty, one pattern each: what readers meet in the wild, and what may come of it.

`python -m tests.support.fault_files FOLDER` writes them all.
"""

import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

from tests.support.cad_parts import as_nurbs, drilled, rod
from tests.support.fuzz_seeds import _assembly

#: What must come of a file: nothing said, a warning and nothing lost, faces lost, or a refusal.
FINE, WARNED, LOST, REFUSED = "fine", "warned", "lost", "refused"


class Faulty(NamedTuple):
    """A pattern: the file to start from, the change, what comes of it, faces that are left, and of those altered."""

    seed: str
    change: Callable[[str], str]
    outcome: str
    faces: int = 7
    altered: int = 0


def seeds(folder: Path) -> dict[str, str]:
    """Texts of the whole files: a drilled block of 7 faces, a rod of B-splines of 3, an assembly of two of 7."""
    found = {}
    shapes = {"drilled": drilled(), "rod": as_nurbs(rod()), "cylinder": rod(), "inch": drilled()}
    for name, shape in shapes.items():
        Interface_Static.SetCVal_s("write.step.unit", "INCH" if name == "inch" else "MM")
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_AsIs)
        writer.Write(str(folder / f"{name}.step"))
        found[name] = (folder / f"{name}.step").read_text()
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    _assembly(folder / "assembly.step")
    found["assembly"] = (folder / "assembly.step").read_text()
    return found


def swap(pattern: str, new: str, count: int = 1) -> Callable[[str], str]:
    """Replace what must be there."""

    def change(text: str) -> str:
        out, found = re.subn(pattern, new, text, count=count)
        assert found, pattern
        return out

    return change


def drop(kind: str) -> Callable[[str], str]:
    """Take the first statement of a kind out of the file."""
    return swap(rf"#\d+ = {kind}\([^;]*;\n", "")


def add(statements: str) -> Callable[[str], str]:
    """More statements at the end; `%FACE%` and `%SHAPE%` are the first face and the product's shape."""

    def change(text: str) -> str:
        body = statements
        for word, kind in (("%FACE%", "ADVANCED_FACE"), ("%SHAPE%", "PRODUCT_DEFINITION_SHAPE")):
            found = re.search(rf"(#\d+) = {kind}", text)
            assert found
            body = body.replace(word, found[1])
        head, _, tail = text.rpartition("ENDSEC;")
        return f"{head}{body}\nENDSEC;{tail}"

    return change


PATTERNS = {
    # --- what touches no geometry --------------------------------------------------------------------------------
    "name missing": Faulty("drilled", swap(r"ADVANCED_FACE\(''", "ADVANCED_FACE($"), FINE),
    "dimensions of a unit": Faulty("drilled", swap(r"NAMED_UNIT\(\*\)", "NAMED_UNIT($)"), FINE),
    "dimensions of a unit no entity": Faulty("inch", swap(r"(CONVERSION_BASED_UNIT[^;]*NAMED_UNIT\()\s*#\d+", r"\g<1>5"), WARNED),
    "dimension of the wrong type": Faulty(
        "drilled",
        add("#9001=SHAPE_ASPECT('','',%SHAPE%,.T.);\n#9002=DIMENSIONAL_LOCATION('','',#9001,%FACE%);\n"
            "#9003=DIMENSIONAL_SIZE(%FACE%,'');\n#9004=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#9002,%FACE%);"),
        WARNED,
    ),
    "dangling in a tolerance": Faulty(
        "drilled", add("#9001=FLATNESS_TOLERANCE('','',#9999,#9998);"), WARNED
    ),
    "dangling in annotation": Faulty(
        "drilled", add("#9001=ANNOTATION_PLANE('',(#9999),#9998,$);\n#9002=DRAUGHTING_CALLOUT('',(#9001,#9997));"), WARNED
    ),
    "unknown entity in annotation": Faulty(
        "drilled", add("#9001=FANCY_ANNOTATION('',#9002,.LOUD.);\n#9002=ANNOTATION_OCCURRENCE('',(#9001),#9001);"), WARNED
    ),
    "point of annotation without numbers": Faulty(
        "drilled",
        add("#9001=CARTESIAN_POINT('',('x',0.,0.));\n#9002=POLYLINE('',(#9001,#9001));\n"
            "#9003=ANNOTATION_CURVE_OCCURRENCE('',(),#9002);"),
        WARNED,
    ),
    "date that is none": Faulty(
        "drilled", add("#9001=CALENDAR_DATE('x',.T.,13);\n#9002=LOCAL_TIME(25,61,0.,#9001);"), WARNED
    ),
    "style with a wrong enumeration": Faulty(
        "assembly",
        add("#9001=SURFACE_STYLE_RENDERING(.SHINY.,#9002);\n#9002=COLOUR_RGB('',0.,0.,1.);\n"
            "#9003=SURFACE_SIDE_STYLE('',(#9001));\n#9004=SURFACE_STYLE_USAGE(.EVERYWHERE.,#9003);\n"
            "#9005=PRESENTATION_STYLE_ASSIGNMENT((#9004));\n#9006=STYLED_ITEM('',(#9005),%FACE%);"),
        WARNED, 14,
    ),
    "colour out of the world": Faulty(
        "assembly",
        add("#9002=COLOUR_RGB('','red',0.,7.);\n#9007=FILL_AREA_STYLE_COLOUR('',#9002);\n#9008=FILL_AREA_STYLE('',(#9007));\n"
            "#9009=SURFACE_STYLE_FILL_AREA(#9008);\n#9003=SURFACE_SIDE_STYLE('',(#9009));\n"
            "#9004=SURFACE_STYLE_USAGE(.BOTH.,#9003);\n#9005=PRESENTATION_STYLE_ASSIGNMENT((#9004));\n"
            "#9006=STYLED_ITEM('',(#9005),%FACE%);"),
        WARNED, 14,
    ),
    "validation property with a wrong number": Faulty(
        "drilled",
        add("#9001=PROPERTY_DEFINITION('geometric validation property','',%FACE%);\n"
            "#9002=MEASURE_REPRESENTATION_ITEM('volume',VOLUME_MEASURE('many'),#9009);\n"
            "#9003=REPRESENTATION('',(#9002),#9008);\n#9004=PROPERTY_DEFINITION_REPRESENTATION(#9001,#9003);"),
        WARNED,
    ),
    "count that was rounded": Faulty(
        "drilled",
        add("#9001=INTEGER_REPRESENTATION_ITEM('count',7.5);\n#9002=REPRESENTATION('',(#9001),#9009);"), WARNED
    ),
    "property of the wrong thing": Faulty(
        "drilled", add("#9001=PROPERTY_DEFINITION('','',#1);\n#9002=GENERAL_PROPERTY_ASSOCIATION('','',#1,#9001);"), WARNED
    ),
    # --- geometry whose border shows that it is whole ----------------------------------------------------------------
    "seam with twice the same curve": Faulty(
        "cylinder", swap(r"(SEAM_CURVE\('',#\d+,\()(#\d+),#\d+", r"\1\2,\2"), WARNED, 3
    ),
    "direction across a plane of the wrong type": Faulty(
        "drilled", swap(r"(PLANE\('',#(\d+)\);[\s\S]*?#\2 = AXIS2_PLACEMENT_3D\('',#\d+,#\d+,#)\d+", r"\g<1>1"), WARNED
    ),
    "form of a surface no enumeration": Faulty("rod", swap(r"(B_SPLINE_SURFACE\([^;]*?)\.UNSPECIFIED\.", r"\1.XX."), WARNED, 3),
    # --- faces that are lost -------------------------------------------------------------------------------------
    "surface dangling": Faulty("drilled", swap(r"(ADVANCED_FACE\('',\([^)]*\),#)\d+", r"\g<1>99999"), LOST, 6),
    "surface of the wrong type": Faulty("drilled", swap(r"(ADVANCED_FACE\('',\([^)]*\),#)\d+", r"\g<1>1"), LOST, 6),
    "surface that cannot be": Faulty("drilled", swap(r"(CYLINDRICAL_SURFACE\('',#\d+,)3", r"\g<1>-3"), LOST, 6),
    "face missing": Faulty("drilled", drop("ADVANCED_FACE"), LOST, 6),
    "face of no known kind": Faulty("drilled", swap("ADVANCED_FACE", "ADVANCED_FAKE"), LOST, 6),
    "face whose kind is no word": Faulty("drilled", swap("ADVANCED_FACE", "ADVANCED@FACE"), LOST, 6),
    "face that no shell takes": Faulty("drilled", swap(r"(CLOSED_SHELL\('',\()#\d+,", r"\1"), LOST, 6),
    "knots that are too many": Faulty("rod", swap(r"(B_SPLINE_SURFACE_WITH_KNOTS\(\()\d+", r"\g<1>9", 0), LOST, 2),
    "knots out of order": Faulty("rod", swap(r"(SURFACE_WITH_KNOTS\(\([^)]*\),\([^)]*\),\()[^,)]*", r"\g<1>99."), LOST, 2),
    "weight of zero": Faulty("rod", swap(r"(RATIONAL_B_SPLINE_SURFACE\(\(\s*\()[^,)]*", r"\g<1>0.", 1), LOST, 2),
    "edge without a vertex": Faulty("drilled", swap("VERTEX_POINT", "VERTEX_PAINT"), LOST, 4),
    "face with a wrong statement": Faulty("drilled", swap(r"ADVANCED_FACE\('',", "ADVANCED_FACE('',(("), LOST, 6),
    "point of a vertex dangling": Faulty("drilled", swap(r"(VERTEX_POINT\('',#)\d+", r"\g<1>99999"), LOST, 4),
    "placement of a plane dangling": Faulty("drilled", swap(r"(PLANE\('',#)\d+", r"\g<1>99999"), LOST, 6),
    # --- faces that are altered ----------------------------------------------------------------------------------
    "bound dangling": Faulty("drilled", swap(r"(ADVANCED_FACE\('',\(#)\d+", r"\g<1>99999"), LOST, 7, 1),
    "edge loop missing": Faulty("drilled", drop("EDGE_LOOP"), LOST, 7, 1),
    "use of an edge missing": Faulty("drilled", drop("ORIENTED_EDGE"), LOST, 7, 1),
    "use of an edge that is none": Faulty("drilled", swap(r"(ORIENTED_EDGE\('',\*,\*,#)\d+", r"\g<1>99999"), LOST, 7, 1),
    "edge that a loop leaves out": Faulty("drilled", swap(r"(EDGE_LOOP\('',\(#\d+),#\d+", r"\1"), LOST, 7, 1),
    "curve of an edge dangling": Faulty("drilled", swap(r"(EDGE_CURVE\('',#\d+,#\d+,#)\d+", r"\g<1>99999"), LOST, 7, 2),
    "circle without a radius": Faulty("drilled", swap(r"(CIRCLE\('',#\d+,)3\.", r"\1'x'"), LOST, 7, 2),
    "cylinder without a radius": Faulty("drilled", swap(r"(CYLINDRICAL_SURFACE\('',#\d+,)3\.", r"\1'x'"), LOST, 7, 1),
    "sense that is none": Faulty("drilled", swap(r"(EDGE_CURVE\('',#\d+,#\d+,#\d+,)\.T\.", r"\1.X."), LOST, 7, 2),
    "weight that is no number": Faulty("rod", swap(r"(RATIONAL_B_SPLINE_SURFACE\(\(\s*\([^,)]*,)[^,)]*", r"\1'x'", 1), LOST, 2),
    "component in the wrong place": Faulty(
        "assembly", swap(r"(ITEM_DEFINED_TRANSFORMATION\('','',#\d+,#)\d+", r"\g<1>1"), LOST, 14
    ),
    # --- files in which nothing can be judged --------------------------------------------------------------------
    "point without numbers": Faulty("drilled", swap(r"(VERTEX_POINT[\s\S]*?CARTESIAN_POINT\('',\()[^,]*", r"\1NaN"), REFUSED),
    "direction without numbers": Faulty("drilled", swap(r"(PLANE[\s\S]*?DIRECTION\('',\()[^,]*", r"\1'x'"), REFUSED),
    "length unit that is none": Faulty("drilled", swap(r"SI_UNIT\(\.MILLI\.,\.METRE\.\)", "SI_UNIT(.MILLI.,.MILE.)"), REFUSED),
    "shape missing": Faulty("drilled", drop("CLOSED_SHELL"), REFUSED),
    "syntax": Faulty("drilled", swap(r"DATA;", "DATA"), REFUSED),
}  # fmt: skip


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    whole = seeds(folder)
    for name, pattern in PATTERNS.items():
        (folder / f"{name.replace(' ', '_')}.step").write_text(pattern.change(whole[pattern.seed]))


if __name__ == "__main__":
    main()
