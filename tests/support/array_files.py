"""Archives of arrays as a stranger could write them: each a small change to a good one."""

import io
import json
import warnings
import zipfile
from types import SimpleNamespace

import numpy as np
from hypothesis import strategies as st

from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED
from plan_cutters.report.to_npz import write_postures
from plan_cutters.stages.posture_maps import PostureMaps


def maps(n=6, k=4, cutter="R1L9", **more):
    """Posture maps made by hand: of each verdict some, with two intervals at every other rotation."""
    rng = np.random.default_rng(3)
    frame = np.linalg.qr(rng.standard_normal((n, 3, 3)))[0]
    verdict = np.resize(np.array([ACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, INACCESSIBLE, UNJUDGED], np.uint8), n)
    count = np.where(np.isin(verdict, (ACCESSIBLE, INTERFERENCE_FREE)), 2, 0)[:, None] * (np.arange(k) % 2)
    pieces = np.tile([[0.1, 0.3], [0.5, 1.2]], (int(count.sum()) // 2, 1))
    words = {
        "rotations": 2.0 * np.pi * np.arange(k) / k, "offset": np.concatenate([[0], np.cumsum(count)]).astype(np.int64),
        "free": pieces.reshape(-1, 2), "undecided": np.zeros((n, k), np.float32),
        "normal": np.ascontiguousarray(frame[:, 0]), "direction_max": np.ascontiguousarray(frame[:, 1]),
        "verdict": verdict, "reason": np.where(np.isin(verdict, (INACCESSIBLE, UNDECIDED)), 3, 255).astype(np.uint8),
        "tilt": (0.0, np.pi / 2), "tolerance": 0.01, "cutter": cutter, "part": "0" * 64,
        "inside": np.zeros(n, bool), "about": {"method": 2, "setup": [0.0, 0.0, 1.0], "x": None},
    }  # fmt: skip
    return PostureMaps(**words | more)


def written(path, found):
    write_postures(SimpleNamespace(maps=found), None, path)
    return path


def members(path):
    """The file's members, by their names."""
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def packed(found, *, way=zipfile.ZIP_DEFLATED):
    """Bytes of an archive of (name, bytes)."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", way) as archive:
        for name, data in found:
            archive.writestr(name, data)
    return out.getvalue()


def npy(array, **more):
    out = io.BytesIO()
    np.lib.format.write_array(out, array, **more)
    return out.getvalue()


def array_of(data):
    return np.load(io.BytesIO(data), allow_pickle=False)


_ODD = (np.nan, np.inf, -np.inf, 1e300, -1e300, -1.0, 0.0, 2.0**62, 1e-320, 7.5)


@st.composite
def changed(draw, good):
    """Bytes of a file: one to three changes to the members of a good one, then perhaps to its bytes."""
    found = list(good.items())
    for _ in range(draw(st.integers(1, 3))):
        if not found:
            break
        at = draw(st.integers(0, len(found) - 1))
        name, data = found[at]
        kind = draw(st.sampled_from(["value", "value", "value", "type", "shape", "drop", "twice", "cut", "text", "about",
                                     "header", "object", "empty", "name"]))  # fmt: skip
        try:
            array = array_of(data)
        except Exception:  # numpy's own reader is not the one that is tried
            array = np.zeros(3)
        if kind == "value" and array.size and array.dtype.kind in "biuf":
            flat = array.reshape(-1).copy()
            row = draw(st.integers(0, flat.size - 1))
            with np.errstate(all="ignore"):
                if array.dtype.kind == "f":
                    flat[row] = draw(st.one_of(st.sampled_from(_ODD), st.floats(-10, 10)))
                elif array.dtype.kind == "b":
                    flat = flat.view(np.uint8)
                    flat[row] = draw(st.integers(0, 255))
                    flat = flat.view(bool)
                else:
                    info = np.iinfo(array.dtype)
                    flat[row] = draw(st.one_of(st.sampled_from([info.min, info.max, 0, 1]), st.integers(info.min, info.max)))
            found[at] = name, npy(flat.reshape(array.shape))
        elif kind == "type" and array.dtype.kind in "biuf":
            wanted = draw(st.sampled_from(["<f8", ">f8", "<f4", "<i8", "<i4", "|u1", "|b1", "<c16", "<M8[s]", "<U3"]))
            with np.errstate(all="ignore"):
                plain = array.astype("<f8").astype("<i8") if wanted[1] in "Mbu" else array
                found[at] = name, npy(plain.astype(wanted))
        elif kind == "shape":
            flat = array.reshape(-1)
            few = draw(st.integers(0, 2 * flat.size + 1))
            found[at] = (
                name,
                npy(np.resize(flat, draw(st.sampled_from([(few,), (few, 1), (1, few), (few, 2), (2, 2, few), ()])))),
            )
        elif kind == "drop":
            del found[at]
        elif kind == "twice":
            found.append((name, data))
        elif kind == "cut":
            found[at] = name, data[: draw(st.integers(0, len(data)))]
        elif kind == "text":
            found[at] = name, npy(np.array(draw(st.text(max_size=20))))
        elif kind == "about" and dict(found).get("about.npy"):
            found = [(each, npy(np.array(draw(_about(old)))) if each == "about.npy" else old) for each, old in found]
        elif kind == "header":
            place = draw(st.integers(0, min(len(data), 128) - 1)) if data else 0
            found[at] = name, data[:place] + bytes([draw(st.integers(0, 255))]) + data[place + 1 :]
        elif kind == "object":
            found[at] = name, npy(np.array([{}, None], object), allow_pickle=True)
        elif kind == "empty":
            found[at] = name, b""
        elif kind == "name":
            found[at] = draw(st.sampled_from(["../x.npy", "a/b.npy", "x", ".npy", "offset_R1L9.npy"])), data
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of members that are there twice
        data = packed(found, way=draw(st.sampled_from([zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2])))
    end = draw(st.sampled_from(["", "", "", "cut", "flip", "front"]))
    if end == "cut":
        data = data[: draw(st.integers(0, len(data)))]
    elif end == "flip" and data:
        place = draw(st.integers(0, len(data) - 1))
        data = data[:place] + bytes([data[place] ^ draw(st.integers(1, 255))]) + data[place + 1 :]
    elif end == "front":
        data = draw(st.binary(max_size=40)) + data
    return data


@st.composite
def _about(draw, data):
    try:
        about = json.loads(str(array_of(data).reshape(-1)[0]))
    except Exception:
        return "{}"
    if not isinstance(about, dict):
        return "[]"
    odd = st.sampled_from([None, True, -1, 0, 3.5, "", "R1L9", [], {}, [1, 2], 10**400, [0, 1e999], float("nan")])
    word = draw(st.sampled_from([*about, "question"]))
    if word == "question" and isinstance(about.get(word), dict) and about[word] and draw(st.booleans()):
        about[word][draw(st.sampled_from(sorted(about[word])))] = draw(odd)
    else:
        about[word] = draw(odd)
    return json.dumps(about)
