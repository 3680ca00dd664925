"""A SARIF file as its standard and code scanning of GitHub have it, checked by its structure."""

import json
import re
from types import SimpleNamespace

#: A reference of RFC 3986, without an unescaped space or bracket.
_REFERENCE = re.compile(r"[A-Za-z0-9._~!$&'()*+,;=:@/%-]+")


def findings(data):
    """The findings of a file that is valid: part, rule, level and text of each."""
    file = json.loads(data)
    assert set(file) == {"$schema", "version", "runs"}
    assert file["version"] == "2.1.0"
    (run,) = file["runs"]
    assert set(run) == {"tool", "automationDetails", "columnKind", "results"}
    driver = run["tool"]["driver"]
    assert set(driver) == {"name", "version", "rules"}
    ids = [rule["id"] for rule in driver["rules"]]
    assert len(set(ids)) == len(ids)
    assert all(rule["shortDescription"]["text"] for rule in driver["rules"])
    found = []
    for each in run["results"]:
        assert each["level"] in ("error", "warning")
        assert ids[each["ruleIndex"]] == each["ruleId"]
        (place,) = each["locations"]
        uri = place["physicalLocation"]["artifactLocation"]["uri"]
        assert _REFERENCE.fullmatch(uri)
        assert place["physicalLocation"]["region"] == {"startLine": 1}
        assert each["message"]["text"]
        assert each["partialFingerprints"]["case/v1"]
        found.append(SimpleNamespace(part=uri, rule=each["ruleId"], level=each["level"], text=each["message"]["text"]))
    marks = [each["partialFingerprints"]["case/v1"] for each in run["results"]]
    assert len(set(marks)) == len(marks)
    return found
