"""The page of results: a table of the programs, one of each class of parts, and the settings."""

import json
from pathlib import Path
from typing import Any

#: Columns of a table of results: title and key.
CELLS = (
    ("postures", "postures"),
    ("border", "border"),
    ("right", "right"),
    ("false safe", "false_safe"),
    ("false blocked", "false_blocked"),
    ("undecided", "undecided"),
    ("worst mm", "worst_mm"),
    ("score", "score"),
)


def cells(counted: dict[str, Any]) -> list[str]:
    """Return the cells of a row; the worst of angles stands beside that of depths, where there is one."""
    out = []
    for _, key in CELLS:
        value = counted[key]
        if key == "score":
            out.append("-" if value is None else f"{100 * value:.1f} %")
        elif key == "worst_mm":
            turned = f", {counted['worst_deg']:.3g} deg" if counted["worst_deg"] else ""
            out.append(("-" if not value and not turned else f"{value:.3f}") + turned)
        else:
            out.append(str(value))
    return out


def page(folder: Path) -> str:
    """Return the Markdown page of all results in a folder.

    Raises
    ------
    ValueError
        There are none, or one of the files is no file of results.
    """
    found = []
    for path in sorted(folder.glob("*.json")):
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
        except ValueError:
            raise ValueError(f"{path.name}: no JSON") from None
        if document.get("format") != "cutter-accessibility-results":
            raise ValueError(f"{path.name}: no file of results")
        found.append(document)
    if not found:
        raise ValueError(f"no results in {folder.name}: write one with `run --json`")
    lines = [
        "# Results",
        "",
        "Made by `python -m conformance table`. *False safe* is what breaks a tool: look there first. "
        "*Border*: within the tolerance "
        "of the surface, where each answer is right. *Score*: right answers among all others.",
    ]
    for kind in sorted({d["kind"] for d in found}):
        for claims in (False, True):
            mine = sorted((d for d in found if d["kind"] == kind and d["claims"] == claims), key=_rank)
            if mine:
                lines += _section(kind, claims, mine)
    lines += _seed()
    return "\n".join(lines) + "\n"


def _seed() -> list[str]:
    """Return the seed's first example: the paper's figures beside the truth."""
    from conformance.suite import read

    printed = {0.0: ("27.5994", "61.3466"), 50.0: ("closes at 52.2388", "")}
    rows = []
    for answer in read("made").parts["v_groove"].answers:
        turn, free = answer["rotation_deg"], answer["value"]
        rows.append([f"{turn:g}", *printed.get(turn, ("", "")), *((f"{free[0][0]:.4f}", f"{free[0][1]:.4f}") if free else ("none", "none"))])
    return [
        "",
        "## The seed's examples",
        "",
        "Li and Zhang, *Flat-end cutter accessibility determination in 5-axis milling of sculptured surfaces*, first example: the part "
        "`v_groove`, flat end of radius 8 and length 90 at the middle of the bottom line, angles in degrees. The paper prints two bounds at "
        "rotation 0 and where local gouging closes; it states 0.69 % and 0.15 % as its largest deviations at other rotations. Its rule "
        "for rear gouging takes a point that is free at tilt 0 as free for good, which is not so.",
        "",
        *_table(["rotation", "paper, free from", "paper, free to", "true, free from", "true, free to"], rows),
        "",
        "The second example is one sculptured patch that was not published (201 x 201 samples; 43.2 % convex, 86.9 % of these free of "
        "interference with R 6; of R 12, 10, 8 and 6 the largest that reaches all is 6). Without the surface nobody can repeat it, so it has no truth here.",
    ]


def _rank(document: dict[str, Any]) -> tuple[bool, int, float, str]:
    """Return the key of the order: the fewest false safe answers first, but who decides nothing comes last."""
    return not document["score"], document["false_safe"], -(document["score"] or 0.0), document["program"]


def _section(kind: str, claims: bool, found: list[dict[str, Any]]) -> list[str]:
    """Return the lines of one half of the suite."""
    title = f"{kind.capitalize()} parts" + (": postures that a program names itself" if claims else "")
    lines = ["", f"## {title}", "", f"Benchmark {found[0]['version']}, tolerance {found[0]['tolerance_mm']:g} mm."]
    heads = ["program", "parts", *(head for head, _ in CELLS), "seconds", "MB"]
    lines += [
        "",
        *_table(
            heads,
            [
                [
                    d["program"] + ("" if d["all"] or claims else " (part of the postures)"),
                    str(d["parts"]),
                    *cells(d),
                    f"{d['seconds']:.1f}",
                    f"{d['memory_mb']:.0f}",
                ]
                for d in found
            ],
        ),
    ]
    families = list(dict.fromkeys(name for d in found for name in d["families"]))
    lines += ["", "### False safe, false blocked and undecided by class of part", ""]
    rows = []
    for family in families:
        counted = [d["families"].get(family) for d in found]
        rows.append(
            [family, *("-" if c is None else f"{c['false_safe']} / {c['false_blocked']} / {c['undecided']} of {c['postures'] - c['border']}" for c in counted)]
        )
    lines += _table(["class", *(d["program"] for d in found)], rows)
    lines += ["", "### Settings", ""]
    for d in found:
        settings = ", ".join(f"{key} {value}" for key, value in d["settings"].items()) or "none"
        versions = ", ".join(f"{key} {value}" for key, value in d["versions"].items() if not value.startswith("not installed"))
        why = "; ".join(f"{reason} ({count})" for reason, count in d["why"].items())
        lines.append(f"- {d['program']}: {settings}. Versions: {versions}." + (f" Undecided: {why}." if why else ""))
    return lines


def _table(heads: list[str], rows: list[list[str]]) -> list[str]:
    """Return a table in Markdown."""

    def clean(text: str) -> str:
        return text.replace("|", "/")

    return ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads), *("| " + " | ".join(map(clean, row)) + " |" for row in rows)]
