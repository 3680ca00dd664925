"""A JUnit file as the schemas of Surefire and of Jenkins' xUnit plugin have it, checked by its structure."""

import re
from types import SimpleNamespace
from xml.etree import ElementTree as ET

#: Elements with their children in order, attributes that must be there, and those that may.
_FORM = {
    "testsuite": (("testcase",), {"name", "tests", "failures", "errors", "skipped", "time"}, set()),
    "testcase": (("failure", "skipped", "error"), {"name", "classname", "time"}, set()),
    "failure": ((), {"message", "type"}, set()),
    "error": ((), {"message", "type"}, set()),
    "skipped": ((), {"message"}, set()),
}
_TIME = re.compile(r"\d+\.\d{3}")


def cases(data):
    """The cases of a file that is valid: classname, name, outcome, message and details of each."""
    root = ET.fromstring(data)
    assert root.tag == "testsuite"
    for element in root.iter():
        children, must, may = _FORM[element.tag]
        assert must <= set(element.attrib) <= must | may, element.attrib
        assert {each.tag for each in element} <= set(children)
        if "time" in element.attrib:
            assert _TIME.fullmatch(element.attrib["time"])
        if element.tag in ("testcase", "testsuite"):
            assert not (element.text or "").strip()
        else:
            assert element.attrib["message"].strip() == " ".join(element.attrib["message"].split())
            assert element.attrib.get("type", "x")
    found = []
    for row in root:
        assert len(row) <= 1
        end = row[0] if len(row) else None
        said = {} if end is None else {"message": end.get("message"), "details": end.text or "", "kind": end.get("type", "")}
        empty = {"message": "", "details": "", "kind": ""}
        outcome = "passed" if end is None else end.tag
        found.append(SimpleNamespace(part=row.get("classname"), name=row.get("name"), outcome=outcome, **{**empty, **said}))
    assert int(root.get("tests")) == len(found)
    for attribute, outcome in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        assert int(root.get(attribute)) == sum(each.outcome == outcome for each in found)
    # Readers take a case by both names.
    assert len({(each.part, each.name) for each in found}) == len(found)
    return found


def outcomes(found):
    """The outcomes that there are."""
    return {each.outcome for each in found}
