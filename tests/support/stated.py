"""STEP files that state sizes, tolerances and threads of faces as AP242 has them."""

import math

import cadquery as cq

#: Of one size (recommended practices for semantic PMI, 5.2): the aspect, its face and representation, the dimension, and its own.
_SIZE = """#{a}=SHAPE_ASPECT('','',{shape},.T.);
#{b}=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#{a},{rep},{face});
#{c}=DIMENSIONAL_SIZE(#{a},'{kind}');
#{d}=(LENGTH_MEASURE_WITH_UNIT()MEASURE_REPRESENTATION_ITEM()
MEASURE_WITH_UNIT(POSITIVE_LENGTH_MEASURE({value}),{unit})REPRESENTATION_ITEM('nominal value'));
#{e}=SHAPE_DIMENSION_REPRESENTATION('',(#{d}{more}),{context});
#{f}=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(#{c},#{e});
"""
_INCH = """#{a}=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#{b}=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{a});
#{c}=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);
#{d}=(CONVERSION_BASED_UNIT('INCH',#{b})LENGTH_UNIT()NAMED_UNIT(#{c}));
"""


def stated(path, shape, sizes, *, inch=False):
    """Write a shape, with sizes by the radius of the cylinders that they are of, mm: value, notes, deviations or class, and kind.

    `sizes`: radius -> dict of `value`, `notes`, `deviations` (lower, upper), `fit` (form, grade), `kind`; values in the unit.
    """
    cq.exporters.export(cq.Workplane(obj=shape), str(path))
    rows = {
        key.strip(): text
        for key, _, text in (row.partition("=") for row in path.read_text().split(";"))
        if key.strip()[:1] == "#"
    }
    rows = {key: " ".join(text.split()) for key, text in rows.items()}

    def first(kind):
        return next(key for key, text in rows.items() if text.startswith(kind))

    rep, context = first("ADVANCED_BREP_SHAPE_REPRESENTATION"), None
    context = rows[rep].rpartition("#")[2].strip(" )")
    unit = next(key for key, text in rows.items() if "SI_UNIT" in text and ".METRE." in text)
    known = {"shape": first("PRODUCT_DEFINITION_SHAPE"), "rep": rep, "context": f"#{context}", "unit": unit}
    number, text = 1 + max(int(key[1:]) for key in rows), ""
    if inch:
        text += _INCH.format(**{name: number + k for k, name in enumerate("abcd")})
        known["unit"], number = f"#{number + 3}", number + 4
    for radius, size in sizes.items():
        surfaces = {key for key, row in rows.items() if row.startswith("CYLINDRICAL_SURFACE") and math.isclose(
            float(row.rpartition(",")[2].strip(" )")), radius, abs_tol=1e-6)}  # fmt: skip
        for face in [k for k, row in rows.items() if row.startswith("ADVANCED_FACE") and any(f"{s}," in row for s in surfaces)]:
            at = {name: number + k for k, name in enumerate("abcdef")}
            number += 6
            notes = [f"#{number + k}" for k in range(len(size.get("notes", ())))]
            more = "".join(f",{each}" for each in notes)
            text += _SIZE.format(face=face, value=size["value"], kind=size.get("kind", "diameter"), more=more, **at, **known)
            for key, note in zip(notes, size.get("notes", ()), strict=True):
                text += f"{key}=DESCRIPTIVE_REPRESENTATION_ITEM('dimensional note','{note}');\n"
            number += len(notes)
            if "fit" in size:
                form, grade = size["fit"]
                text += f"#{number}=LIMITS_AND_FITS('{form}','hole','{grade}','');\n"
            elif "deviations" in size:
                for k, value in enumerate(size["deviations"], 1):
                    text += f"#{number + k}=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE({value:.6f}),{known['unit']});\n"
                text += f"#{number}=TOLERANCE_VALUE(#{number + 1},#{number + 2});\n"
            if "fit" in size or "deviations" in size:
                text += f"#{number + 3}=PLUS_MINUS_TOLERANCE(#{number},#{at['c']});\n"
                number += 4
    data = path.read_text()
    end = data.rindex("ENDSEC")
    path.write_text(f"{data[:end]}{text}{data[end:]}")
    return path
