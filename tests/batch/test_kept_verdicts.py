"""Verdicts that are kept by cutter: what is found is what judging would give, and nothing else is used."""

import os
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import plan_cutters
from plan_cutters import Cutter, Machine, Options, PlanError
from plan_cutters.batch import verdicts as kept_verdicts
from plan_cutters.batch.verdicts import VerdictCache, packed, unpacked
from plan_cutters.document.clock import Clock
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, NO_REASON, UNJUDGED, WORDS, Verdicts
from plan_cutters.pipeline import prepare, run
from plan_cutters.scene.work import Work
from plan_cutters.stages.judge import judge
from tests.support.places import SAMPLES

PART, OTHER = SAMPLES / "v_groove.step", SAMPLES / "peaks_and_valleys.step"
ASKED = {"cutters": ("R6L60", "R3L40"), "grid": 21, "rotation_step": 0.35, "area_budget": 0, "patterns": False}


def told(result):
    """The plan, but for how long it took."""
    return result.plan.model_dump(exclude={"run"})


def planned(folder, part=PART, **asked):
    """A plan with kept verdicts; which cutters were judged, and what was said."""
    judged = []

    def counted(ready, cutter, *given, **more):
        judged.append(cutter.id)
        return judge(ready, cutter, *given, **more)

    kept = VerdictCache(str(folder), counted)
    result = run(part, Options.of(ASKED | asked), Clock(), judged=kept)
    assert (kept.judged, kept.found + kept.judged) == (len(judged), len(result.cutters))
    return result, judged, kept.faults


@pytest.mark.slow("runs a batch", only=("folder",))
@pytest.mark.parametrize("where", ["folder", "memory"])
def test_the_same_plan_again_judges_nothing_and_is_the_same(tmp_path, where):
    folder = tmp_path / "kept" if where == "folder" else f"memory://{tmp_path.name}"
    asked = {"grid": 7, "area_budget": None}
    plain = run(PART, Options.of(ASKED | asked), Clock())
    for expected in (["R3L40", "R6L60"], []):
        result, judged, faults = planned(folder, **asked)
        assert (judged, faults) == (expected, [])
        # With the bound of the area, which follows from the work of the searches.
        assert told(result) == told(plain)
        assert all(result.here[cutter] == verdicts for cutter, verdicts in plain.here.items())


def test_storage_that_cannot_be_reached_is_asked_and_reported_once(monkeypatch):
    asked = []

    def refused(self, *words):
        asked.append(words)
        raise PermissionError(13, "Access Denied")

    for name in ("get", "put", "names"):
        monkeypatch.setattr(kept_verdicts.Folder, name, refused)
    result, judged, faults = planned("memory://nobody")
    assert judged == ["R3L40", "R6L60"]
    assert faults == ["--verdicts memory://nobody: cannot be read: Access Denied; verdicts are not stored"]
    assert len(asked) == 1
    assert told(result) == told(run(PART, Options.of(ASKED), Clock()))


def test_another_cutter_is_judged_alone_and_a_part_too(tmp_path):
    planned(tmp_path)
    three = (*ASKED["cutters"], "R5L70")
    result, judged, _ = planned(tmp_path, cutters=three)
    assert judged == ["R5L70"]
    plain = run(PART, Options.of(ASKED | {"cutters": three}), Clock())
    for cutter, verdicts in plain.here.items():
        # Postures may be others, verdicts not.
        assert (result.here[cutter].verdict == verdicts.verdict).all()
    assert planned(tmp_path, OTHER)[1] == ["R3L40", "R6L60"]
    assert planned(tmp_path)[1] == planned(tmp_path, OTHER)[1] == []


def test_the_entry_of_the_same_company_comes_first(tmp_path):
    """Others were kept meanwhile: the plan of before has its own bytes all the same."""
    first = planned(tmp_path)[0]
    ready = prepare(PART, Options.of(ASKED))
    cutter = ready.cutters[0]
    kept = VerdictCache(str(tmp_path))
    alone = kept(ready, cutter, known=None)  # an entry of the same cutter serves
    assert (kept.found, kept.judged) == (1, 0)
    assert alone == first.here[cutter.id]
    assert told(planned(tmp_path)[0]) == told(first)


@pytest.mark.parametrize(
    ("asked", "again"),
    [
        ({"jobs": 1, "area_budget": 9}, []),
        ({"answers": "stick-out", "feed": 100.0, "length_over_radius": 5.0}, []),
        ({"machine": Machine(name="another name")}, []),
        ({"cutters": (replace(Cutter.parse("R6L60"), name="my own"), "R3L40")}, []),
        ({"grid": 22}, ["R3L40", "R6L60"]),
        ({"machine": "tilt:60"}, ["R3L40", "R6L60"]),
        ({"machine": "trunnion-ac"}, ["R3L40", "R6L60"]),
        ({"setup": (0, 0.1, 1)}, ["R3L40", "R6L60"]),
        ({"tilt": (0.0, 1.0)}, ["R3L40", "R6L60"]),
        ({"rotation_step": 0.3}, ["R3L40", "R6L60"]),
        ({"tolerance": 0.02}, ["R3L40", "R6L60"]),
        ({"fixtures": "table"}, ["R3L40", "R6L60"]),
        ({"allowance": 0.1}, ["R3L40", "R6L60"]),
        ({"cutters": ("R6L61", "R3L40")}, ["R6L61"]),
    ],
)  # fmt: skip
def test_only_what_verdicts_depend_on_counts(before, asked, again):
    folder, ready = before
    kept = VerdictCache(str(folder))
    kept._write = lambda *given: None
    there = prepare(PART, Options.of(ASKED | asked)) if asked else ready
    told = []
    kept._otherwise = lambda ready, cutter, *given, **more: told.append(cutter.id) or judge(ready, cutter, *given, **more)
    for cutter in reversed(there.cutters):
        kept(there, cutter)
    assert [name.partition("F")[0][:5] for name in told] == again


@pytest.fixture(scope="module")
def before(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kept")
    ready = prepare(PART, Options.of(ASKED))
    kept = VerdictCache(str(folder))
    for cutter in ready.cutters:
        kept(ready, cutter)
    return folder, ready


DAMAGES = {
    "empty": lambda content: b"",
    "shorter": lambda content: content[:-7],
    "one bit": lambda content: content[:-40] + bytes([content[-40] ^ 4]) + content[-39:],
    "no entry": lambda content: b"PK\3\4 something else",
    "a text": lambda content: content[: len(b"plan-cutters verdicts 1\n")] + b"{}\n{}\n",
}


@pytest.mark.parametrize("damage", list(DAMAGES))
def test_what_is_damaged_is_said_and_judged_again(tmp_path, damage):
    plain = planned(tmp_path)[0]
    entries = sorted(tmp_path.rglob("*.verdicts"))
    assert len(entries) == 2
    entries[0].write_bytes(DAMAGES[damage](entries[0].read_bytes()))
    result, judged, (fault,) = planned(tmp_path)
    assert len(judged) == 1
    assert "damaged and not used" in fault
    assert "\n" not in fault
    assert told(result) == told(plain)
    assert planned(tmp_path)[1:] == ([], [])  # it was replaced


@pytest.mark.parametrize("kind", ["pipe", "device"])
def test_an_entry_that_is_no_file_is_not_opened(tmp_path, kind):
    """A pipe would be waited for, and a device read until memory ends."""
    plain = planned(tmp_path)[0]
    entry = sorted(tmp_path.rglob("*.verdicts"))[0]
    entry.unlink()
    os.mkfifo(entry) if kind == "pipe" else entry.symlink_to("/dev/zero")
    result, judged, (fault,) = planned(tmp_path)
    assert len(judged) == 1
    assert "is no regular file" in fault
    assert told(result) == told(plain)
    assert planned(tmp_path)[1:] == ([], [])  # it was replaced


def test_an_entry_of_something_else_is_not_used(tmp_path):
    planned(tmp_path)
    one, other = sorted(tmp_path.rglob("*.verdicts"))
    one.write_bytes(other.read_bytes())
    _, judged, (fault,) = planned(tmp_path)
    assert len(judged) == 1
    assert "belongs to something else" in fault


@given(data=st.data(), n=st.integers(0, 40))
@settings(max_examples=30, deadline=None)
def test_an_entry_reads_as_it_was_written_and_no_byte_of_it_can_change(data, n):
    random = np.random.default_rng(n)
    verdicts = Verdicts(
        random.choice(list(WORDS), n).astype(np.uint8), random.normal(size=(n, 3)), np.full((n, 3), np.nan),
        np.full(n, -0.0), random.integers(-1, 9, n, np.int32), random.normal(size=(n, 3)), np.zeros(n, np.uint8),
    )  # fmt: skip
    entry = packed(verdicts, 12, "key")
    found, looked = unpacked(entry, n, "key")
    assert (found, looked) == (verdicts, 12)
    assert found.tilt.tobytes() == verdicts.tilt.tobytes()
    assert not found.axis.flags.writeable
    place = data.draw(st.integers(0, len(entry) - 1))
    changed = entry[:place] + bytes([entry[place] ^ data.draw(st.integers(1, 255))]) + entry[place + 1 :]
    with pytest.raises((ValueError, TypeError, LookupError)):
        unpacked(changed, n, "key")
    for samples, key in ((n + 1, "key"), (n, "other")):
        with pytest.raises(ValueError, match="something else"):
            unpacked(entry, samples, key)


def test_a_place_that_cannot_be_written_costs_nothing(tmp_path):
    (tmp_path / "taken").write_text("a file")
    result, judged, faults = planned(tmp_path / "taken")
    assert len(judged) == 2
    assert told(result) == told(run(PART, Options.of(ASKED), Clock()))
    assert len(faults) == 2
    assert all("cannot be written" in fault for fault in faults)


def test_a_write_that_fails_half_way_leaves_nothing(tmp_path, monkeypatch):
    def full(self, content):
        with open(self, "wb") as file:
            file.write(content[:10])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_bytes", full)
    _, _, faults = planned(tmp_path)
    assert all("No space left on device" in fault for fault in faults)
    assert len(faults) == 2
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


def test_another_program_judges_again(before, monkeypatch):
    folder, ready = before
    monkeypatch.setattr(kept_verdicts, "made_by", lambda: "a later version")
    kept = VerdictCache(str(folder))
    kept._write = lambda *given: None
    kept(ready, ready.cutters[0])
    assert (kept.found, kept.judged) == (0, 1)


def test_rows_and_work_are_as_of_judge(before):
    folder, ready = before
    cutter, rows = ready.cutters[0], np.arange(100, 300)
    kept, one, other = VerdictCache(str(folder)), Work(), Work()
    whole = judge(ready, cutter, work=one)
    assert kept(ready, cutter, work=other) == whole
    assert one.looked == other.looked > 0
    assert kept(ready, cutter, rows) == whole.of(rows)
    assert (whole.verdict != UNJUDGED).any()
    assert INACCESSIBLE in WORDS


def test_python_and_a_wrong_place(tmp_path):
    asked = ASKED
    one, other = (plan_cutters.plan(PART, verdicts=os.fspath(tmp_path / "kept"), **asked) for _ in range(2))
    assert told(one) == told(other) == told(plan_cutters.plan(PART, **asked))
    for where in ("", "nosuch://place"):
        with pytest.raises(PlanError, match="verdicts") as caught:
            plan_cutters.plan(PART, verdicts=where, **asked)
        assert "\n" not in str(caught.value)


FORGERIES = {
    "no axis": lambda v: {"axis": np.full_like(v.axis, np.nan)},
    "an axis of another tilt": lambda v: {"tilt": v.tilt + 0.1},
    "a tilt beyond those searched": lambda v: {"tilt": v.tilt + 7.0, "axis": v.axis},
    "a direction along the normal": lambda v: {"tilt_direction": v.axis},
    "a rotation that is none": lambda v: {"rotation": np.full_like(v.rotation, 99)},
    "accessible without a posture": lambda v: {"verdict": np.full_like(v.verdict, ACCESSIBLE),
                                               "reason": np.full_like(v.reason, NO_REASON)},
    "accessible with a reason": lambda v: {"verdict": np.full_like(v.verdict, ACCESSIBLE)},
    "lost without a reason": lambda v: {"reason": np.full_like(v.reason, NO_REASON)},
}  # fmt: skip


@pytest.mark.slow("starts servers or clusters")
@pytest.mark.parametrize("forgery", FORGERIES)
def test_verdicts_that_cannot_be_of_these_samples_are_not_taken(tmp_path, forgery):
    """With their checksum made anew: whoever may write there may write anything, but not nonsense."""
    asked = {"machine": "tilt:20", "cutters": "R6L60"}  # some are lost, some are not
    plain = planned(tmp_path, **asked)[0]
    (entry,) = tmp_path.rglob("*.verdicts")
    own = entry.parent.name
    verdicts, looked = unpacked(entry.read_bytes(), len(plain.samples), own)
    assert {INACCESSIBLE, ACCESSIBLE} <= set(verdicts.verdict.tolist())
    entry.write_bytes(packed(replace(verdicts, **FORGERIES[forgery](verdicts)), looked, own))
    result, judged, (fault,) = planned(tmp_path, **asked)
    assert judged == ["R6L60"]
    assert "is damaged and not used" in fault
    assert told(result) == told(plain)
    assert planned(tmp_path, **asked)[1:] == ([], [])  # it was replaced


def test_a_key_keeps_out_what_others_wrote(tmp_path):
    """Entries of different keys, and those without one, lie beside each other; a name that is forged is not enough."""
    ready = prepare(PART, Options.of(ASKED))
    cutter = ready.cutters[0]

    def judged_with(key):
        kept = VerdictCache(str(tmp_path), key=key)
        kept(ready, cutter)
        return kept.judged, kept.faults

    for key in (None, b"k" * 16, b"l" * 16):
        assert judged_with(key) == (1, [])
    assert [judged_with(key) for key in (None, b"k" * 16, b"l" * 16)] == [(0, [])] * 3
    entries = sorted(tmp_path.rglob("*.verdicts"))
    assert len(entries) == 3
    mine = next(entry for entry in entries if entry.read_bytes() != entries[0].read_bytes())
    mine.write_bytes(entries[0].read_bytes())
    results = [judged_with(key) for key in (None, b"k" * 16, b"l" * 16)]
    (fault,) = [fault for _, faults in results for fault in faults]
    assert "not sealed with this key" in fault
    assert [count for count, _ in results].count(1) == 1
