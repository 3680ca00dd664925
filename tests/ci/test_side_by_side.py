"""Two plans side by side: the page of `diff --out`, its data, what it says of missing pictures, and in a real browser."""

import base64
import hashlib
import io
import json
import zlib
from html.parser import HTMLParser

import cadquery as cq
import numpy as np
import pytest

from cad_io.read import read_part
from plan_cutters import Cutter, Holder, plan
from plan_cutters.plan_file.model import FileEntry
from plan_cutters.plan_file.shares import FaceVerdicts
from plan_cutters.report.page.write import write_html
from plan_cutters.report.to_json import dumps
from plan_cutters_ci.plans import compare
from plan_cutters_ci.review import MARKS, Side, page, picture_of
from tests.support.browser import opened, touch
from tests.support.forked import run
from tests.support.places import ROOT
from tests.support.review_page import decoded

pytestmark = pytest.mark.slow("opens a browser", but=("test_names_in_files_stay_names",))

AXE = ROOT / "page" / "node_modules" / "axe-core" / "axe.min.js"
NAME = "slot <img src=x>&.step"


def block(deep):
    """A block with a slot from its top, so deep."""
    return cq.Workplane().box(60, 40, 40).cut(cq.Workplane().box(60, 16, deep).translate((0, 0, 20 - deep / 2)))


def planned(deep):
    """The deeper the slot, the less of it is reached under the holder."""
    cutter = Cutter.flat(radius=4, length=14, holder=Holder.parse("R20L30"))
    return plan(read_part(block(deep)), cutters=[cutter], faces="all", grid=5, area_budget=0, jobs=2)


def written(folder, result, **changes):
    """The folder of a plan with its page, as the command leaves it."""
    folder.mkdir(parents=True)
    write_html(result, None, folder / "review.html")
    told = FileEntry(name="review.html", sha256=hashlib.sha256((folder / "review.html").read_bytes()).hexdigest(), size_bytes=1)
    document = result.plan.model_copy(update={"files": {"html": told}, **changes})
    (folder / "plan.json").write_text(dumps(document), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def results():
    return {"old": planned(12), "new": planned(30)}


@pytest.fixture(scope="module")
def folders(results, tmp_path_factory):
    at = tmp_path_factory.mktemp("plans")
    return {word: written(at / word, result) for word, result in results.items()}


@pytest.fixture(scope="module")
def path(folders, tmp_path_factory):
    """The page, as the command writes it."""
    at = tmp_path_factory.mktemp("out")
    done = run("diff", folders["old"], folders["new"], "-o", at / "compared", cwd=at)
    assert (done.returncode, done.stderr) == (1, "")
    assert f"Side by side: {at / 'compared' / 'review.html'}" in done.stdout.splitlines()
    assert done.stdout.splitlines()[-1] == "Something was lost."
    return at / "compared" / "review.html"


class Elements(HTMLParser):
    """Texts of the elements of a page that have an id, and the tags that there are."""

    def __init__(self, data):
        super().__init__()
        self.tags, self.open, self.texts = set(), "", {}
        self.feed(data.decode("utf-8"))

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        self.open = dict(attributes).get("id", "") if tag == "script" else ""

    def handle_endtag(self, _tag):
        self.open = ""

    def handle_data(self, text):
        if self.open:
            self.texts[self.open] = self.texts.get(self.open, "") + text


def test_the_page_has_the_verdicts_of_both_plans(results, path):
    """The arrays are those of the plans, read as the docs say; postures and maps are left out."""
    texts = Elements(path.read_bytes()).texts
    told = json.loads(texts["meta"])
    for word, result in results.items():
        stream = zlib.decompress(base64.b64decode(texts[f"data-{word}"], validate=True), -15)
        arrays = told[word]["arrays"]
        assert not [name for name in arrays if name.startswith(("tilt", "lean", "maps", "scalar", "reason"))]

        def read(name, arrays=arrays, stream=stream):
            entry = arrays[name]
            raw = stream[entry["offset"] : entry["offset"] + entry["bytes"]]
            return decoded(raw, entry["dtype"], entry["shape"], entry["filter"])

        assert (read("sample.face") == result.samples.face).all()
        for name, reach in result.reaches.items():
            assert (read(f"verdict.{name}") == reach.verdict).all()
        assert sum(each["bytes"] for each in arrays.values()) == len(stream)
        assert set(told["states"][word]) == {face.id for face in result.plan.faces}


def test_the_same_plans_give_the_same_bytes(results, folders):
    def made():
        sides = [Side(w, r.plan, picture_of(folders[w] / "plan.json", r.plan)) for w, r in results.items()]
        return page(compare(results["old"].plan, results["new"].plan), *sides)

    assert made() == made()


def test_names_in_files_stay_names(results, tmp_path):
    part = results["old"].plan.part.model_copy(update={"file": NAME})
    old = written(tmp_path / "old", results["old"], part=part)
    assert run("diff", old, old, "-o", "out", cwd=tmp_path).returncode == 0
    data = (tmp_path / "out/review.html").read_bytes()
    assert "img" not in Elements(data).tags
    assert b"&lt;img src=x&gt;" in data


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda page: page.unlink(), b"there is no review.html in the folder of the plan"),
        (lambda page: page.write_bytes(page.read_bytes() + b" "), b"is not the one that was written with the plan"),
    ],
)
def test_a_picture_that_is_missing_is_said(results, folders, tmp_path, spoil, said):
    old = written(tmp_path / "old", results["old"])
    spoil(old / "review.html")
    assert run("diff", old, folders["new"], "-o", "out", cwd=tmp_path).returncode == 1
    data = (tmp_path / "out/review.html").read_bytes()
    assert data.count(b"No picture: ") == 1
    assert said in data
    assert json.loads(Elements(data).texts["meta"])["old"] is None


def test_a_page_that_is_damaged_or_of_another_part_is_no_picture(results, folders):
    """Where the plan has no checksum of its page, what the page says decides."""
    document, at = results["old"].plan, folders["old"]
    assert picture_of(at / "plan.json", document).why == ""
    whole = (at / "review.html").read_text()
    spoiled = {
        whole.replace('id="data">', 'id="data">AAAA', 1): "cannot be read",
        whole.replace('"format":1', '"format":2', 1): "another version",
        whole.replace('{"number":1,"id":"F1"', '{"number":1,"id":"F99"', 1): "another part",
        "": "cannot be read",
    }
    assert len(spoiled) == 4
    assert whole not in spoiled
    aside = at.parent / "spoiled"
    aside.mkdir()
    for text, said in spoiled.items():
        (aside / "review.html").write_text(text)
        found = picture_of(aside / "plan.json", document)
        assert found.meta is None
        assert said in found.why


def test_a_page_never_takes_the_place_of_a_plans_own(folders, tmp_path):
    before = (folders["new"] / "review.html").read_bytes()
    done = run("diff", folders["old"], folders["new"], "-o", folders["new"], cwd=tmp_path)
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    assert "would be overwritten" in done.stderr
    assert (folders["new"] / "review.html").read_bytes() == before


def test_of_many_pairs_those_that_differ_have_a_page(results, tmp_path):
    for side, name, word in (("was", "a b", "old"), ("was", "c", "old"), ("now", "a b", "new"), ("now", "c", "old")):
        written(tmp_path / side / name, results[word])
    left = tmp_path / "out/c/review.html"
    left.parent.mkdir(parents=True)
    left.write_text("of an earlier comparison")
    done = run("diff", "was", "now", "-o", "out", "--markdown", cwd=tmp_path)
    assert done.returncode == 1
    assert "[Both plans side by side](out/a%20b/review.html)" in done.stdout
    assert sorted(each.relative_to(tmp_path / "out").as_posix() for each in tmp_path.glob("out/**/*.html")) == ["a b/review.html"]


@pytest.fixture
def shown(browser):
    """Open a page without a network; in the end it must have said nothing on the console."""
    opened_ = []

    def show(path, width=1366, scheme="light", **more):
        context = browser.new_context(
            viewport={"width": width, "height": 800}, reduced_motion="reduce", color_scheme=scheme, offline=True, **more
        )
        opened_.append((context, opened(context, path)))
        return opened_[-1][1]

    yield show
    said = [page.said for _, page in opened_]
    for context, _ in opened_:
        context.close()
    assert said == [[]] * len(said)


@pytest.mark.parametrize(("width", "scheme"), [(1366, "light"), (1920, "dark"), (390, "light"), (390, "dark")])
def test_axe_finds_nothing(shown, path, width, scheme):
    if not AXE.exists():
        pytest.skip("axe-core is not installed: npm ci in page/")
    found = shown(path, width, scheme)
    assert found.evaluate("document.documentElement.dataset.ready") == "yes"
    assert found.evaluate("document.documentElement.scrollWidth") <= width
    boxes = [found.locator(f"#{word} canvas").bounding_box() for word in ("old", "new")]
    # Both pictures are on the first screen.
    assert all(box["y"] + box["height"] < 800 for box in boxes)
    found.keyboard.press("n")
    found.evaluate(AXE.read_text())
    violations = found.evaluate("axe.run().then(result => result.violations)")
    assert [(each["id"], each["nodes"][0]["html"][:120]) for each in violations] == []


def aims(page):
    """Where both look from, once nothing is left to be drawn."""
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return page.evaluate("compared.sides.map(side => side.stage.table.aim)")


def test_there_is_one_camera(shown, path):
    """Whichever picture is turned, both are seen from one place; so they are after the window has another size."""
    found = shown(path)
    before = aims(found)
    assert before[0] == before[1]
    for word, keys in (("new", ["ArrowLeft"]), ("old", ["ArrowUp", "+"])):
        found.locator(f"#{word} canvas").focus()
        for key in keys:
            found.keyboard.press(key)
        now = aims(found)
        assert now[0] == now[1]
        assert now != before
        before = now
    # Who turns to the other picture before the first one is drawn takes up where that was.
    old, new = (found.locator(f"#{word} canvas") for word in ("old", "new"))
    turns = found.evaluate(
        """([was, now]) => [was, now, was].map(canvas => {
             canvas.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft", bubbles: true}));
             return compared.camera.table.aim.turn; })""",
        [old.element_handle(), new.element_handle()],
    )
    assert turns == [before[0]["turn"] - 8 * k for k in (1, 2, 3)]
    before = aims(found)
    assert before[0] == before[1]
    found.set_viewport_size({"width": 1000, "height": 700})
    assert aims(found) == before


def test_fingers_move_both_pictures(shown, path):
    """A pinch on one picture zooms both and turns none, as a finger turns both and zooms none."""
    found = shown(path, width=390, has_touch=True, is_mobile=True)
    before = aims(found)[0]
    touch(found, [(-20, 0), (-60, 0)], [(20, 0), (60, 0)], picture="#new canvas")
    near, other = aims(found)
    assert near == other
    assert near["half"] == pytest.approx(before["half"] / 3, rel=0.1)
    assert (near["turn"], near["rise"]) == pytest.approx((before["turn"], before["rise"]), abs=1e-6)
    touch(found, [(-40, 0), (40, 0)], picture="#old canvas")
    turned, other = aims(found)
    assert turned == other
    assert turned["half"] == near["half"]
    assert abs(turned["turn"] - near["turn"]) > 10


def hue(page, word, face):
    """Shares of red, green and blue that are seen about the middle of a face, from the side that the page flies to."""
    from PIL import Image

    x, y = page.evaluate(
        """([word, face]) => { const side = compared.sides.find(each => each.word === word), aim = side.aimAt(face);
             side.stage.table.set(aim); side.stage.draw(); return side.stage.project(aim.target); }""",
        [word, face],
    )
    image = np.asarray(Image.open(io.BytesIO(page.locator(f"#{word} .frame").screenshot())).convert("RGB")).astype(float)
    found = image[round(y) - 6 : round(y) + 7, round(x) - 6 : round(x) + 7].reshape(-1, 3).mean(axis=0)
    return found / found.sum()


def near(found, word):
    wanted = np.array(list(bytes.fromhex(MARKS[word][1][1:])), float)
    return np.abs(found - wanted / wanted.sum()).max() < 0.06


def test_lost_faces_have_their_colour_in_both_pictures_and_a_row(shown, results, path):
    difference = compare(results["old"].plan, results["new"].plan)
    lost = next(face for face in difference.faces if face.lost and face.old and face.new)
    changed = {face.new for face in difference.faces}
    # The bottom is one rectangle: its middle lies on it.
    same = min(results["new"].plan.faces, key=lambda face: face.centre_mm[2]).id
    assert same not in changed
    found = shown(path)
    for word, face in (("old", lost.old), ("new", lost.new)):
        assert near(hue(found, word, face), "lost"), face
    assert near(hue(found, "new", same), "reached")
    found.keyboard.press("n")
    row = found.locator("#faces tr.shown")
    assert "lost" in row.inner_text()
    assert found.locator("#status").inner_text().startswith(f"Change 1 of {len(difference.faces)}: ")
    # A click on a face chooses its row.
    found.keyboard.press("Escape")
    assert found.locator("#faces tr.shown").count() == 0
    hue(found, "new", lost.new)
    box = found.locator("#new canvas").bounding_box()
    x, y = found.evaluate("face => compared.sides[1].stage.project(compared.sides[1].aimAt(face).target)", lost.new)
    found.mouse.click(box["x"] + x, box["y"] + y)
    assert found.locator("#faces tr.shown").get_attribute("data-new") == lost.new


def test_verdicts_of_a_cutter_have_the_shares_of_the_plan(shown, results, path):
    found = shown(path)
    for value in ("0", "any"):
        found.select_option("#colouring", value)
        told = {
            row.locator("th").inner_text().strip(): row.locator("td").all_inner_texts()
            for row in found.locator("#legend tbody tr").all()
        }
        for k, result in enumerate(results.values()):
            share = result.plan.cutters[0].area_share.inaccessible
            (seen,) = [each[k] for label, each in told.items() if label == "inaccessible"]
            assert abs(float(seen.strip("<> %")) - 100 * share) < 0.2


def test_a_lost_face_without_samples_has_its_colour(shown, results, folders, tmp_path):
    """Nothing was sampled there: it would be as grey as an obstacle if samples were all that has colour."""
    cutter = results["new"].plan.cutters[0].id
    bare = plan(read_part(block(12)), cutters=[results["old"].judged(cutter)], faces="F1,F2", grid=5, area_budget=0, jobs=2)
    unseen = bare.plan.faces[4]
    assert not unseen.target
    asked = [f.model_copy(update={"target": True}) for f in bare.plan.faces]
    tools = [
        c.model_copy(update={"faces": {f.id: c.faces.get(f.id, FaceVerdicts(unjudged=9)) for f in asked}})
        for c in bare.plan.cutters
    ]
    new = written(tmp_path / "new", bare, faces=asked, cutters=tools)
    done = run("diff", folders["old"], new, "-o", "out", "--despite", "faces", "--json", cwd=tmp_path)
    told = {f["new"]: f["lost"] for f in json.loads(done.stdout)["plans"][0]["faces"]}
    assert told[unseen.id]
    found = shown(tmp_path / "out/review.html")
    assert near(hue(found, "new", unseen.id), "lost")


def test_of_plans_that_are_not_comparable_the_pictures_have_no_changes(shown, results, folders, tmp_path):
    other = results["new"].plan.effective.model_copy(update={"tolerance_mm": 0.5})
    new = written(tmp_path / "new", results["new"], effective=other)
    done = run("diff", folders["old"], new, "-o", "out", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout.splitlines()[-1] == "Not comparable. --despite tolerance compares nevertheless."
    found = shown(tmp_path / "out/review.html")
    assert found.evaluate("document.documentElement.dataset.ready") == "yes"
    assert (found.locator("#faces").count(), found.locator("#cutters").count()) == (0, 0)
    assert found.locator("canvas").count() == 2
    legend = found.locator("#legend").inner_text()
    assert "reached whole" in legend
    assert not any(word in legend for word in ("lost", "won", "both", "neither"))


def test_without_pictures_the_tables_say_it_all(shown, results, tmp_path):
    old, new = (written(tmp_path / word, result) for word, result in results.items())
    for each in (old, new):
        (each / "review.html").unlink()
    run("diff", old, new, "-o", "out", cwd=tmp_path)
    found = shown(tmp_path / "out/review.html")
    assert found.evaluate("document.documentElement.dataset.ready") == "without"
    assert found.locator("canvas").count() == 0
    assert found.locator(".none").count() == 2
    assert "lost" in found.locator("#faces").inner_text()
