"""Parts from files, folders, globs, lists and manifests: their names, and one line for each that cannot be planned."""

import fsspec
import pytest

from plan_cutters.errors import PlanError
from plan_cutters_batch.row import PartRow
from plan_cutters_batch.sources import Source, manifest, sources

KNOWN = ("cutter", "faces", "flip", "spacing", "tolerance")


def found(*words, out="/nowhere/out"):
    return sources([str(word) for word in words], str(out), lambda file: manifest(file, KNOWN))


def names(parts):
    return [part.name for part in parts if isinstance(part, Source)]


def faults(parts):
    return [part.error for part in parts if isinstance(part, PartRow)]


@pytest.fixture
def folder(tmp_path):
    for name in ("b.step", "a.STP", "deep/er/c.iges", "notes.md", "x-plan/annotated.step", ".git/d.step", "out/e.step"):
        file = tmp_path / "parts" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("x")
    return tmp_path / "parts"


def test_a_folder_gives_its_parts_by_their_paths(folder):
    assert names(found(folder, out=folder / "out")) == ["a", "b", "deep/er/c"]
    assert names(found(folder)) == ["a", "b", "deep/er/c", "out/e"]
    assert names(found(folder, out=folder / "out")) == names(found(f"{folder}/", out=folder / "out"))


def test_globs_and_files(folder):
    assert names(found(folder / "*.st*p")) == ["b"]  # letters count, as in a shell
    assert names(found(folder / "**/*.iges")) == ["deep/er/c"]
    assert names(found(folder / "b.step", folder / "deep/er/c.iges")) == ["b", "c"]
    (gone,) = faults(found(folder / "*.brep"))
    assert "no STEP, IGES or BREP file matches it" in gone


def test_an_empty_folder_is_one_line_and_the_others_go_on(folder, tmp_path):
    (tmp_path / "empty").mkdir()
    parts = found(tmp_path / "empty", folder / "b.step")
    assert names(parts) == ["b"]
    assert faults(parts) == [f"{tmp_path / 'empty'}: the folder holds no STEP, IGES or BREP file"]


def test_parts_of_one_name_are_told_and_neither_is_planned(folder, tmp_path):
    other = tmp_path / "B.igs"
    other.write_text("x")
    parts = found(folder / "b.step", other, folder / "a.STP")
    assert names(parts) == ["a"]
    first, second = faults(parts)
    assert str(other) in first
    assert str(folder / "b.step") in second
    assert all(part.status == "failed" and part.code == 2 for part in parts if isinstance(part, PartRow))
    assert len({part.name for part in parts}) == 3


def test_a_file_twice_is_told_too(folder):
    parts = found(folder / "b.step", folder / "b.step")
    assert len({part.name for part in parts}) == len(faults(parts)) == 2


def test_memory_is_a_place_like_others():
    fs = fsspec.filesystem("memory")
    fs.pipe_file("/shelf/one.step", b"x")
    try:
        (part,) = found("memory://shelf")
        assert (part.name, part.file) == ("one", "memory:///shelf/one.step")
        assert faults(found("memory://none/*.step"))
    finally:
        fs.rm("/shelf", recursive=True)


def test_toml(folder):
    file = folder / "parts.toml"
    file.write_text(
        "[options]\nspacing = 0.5\n\n[[part]]\nfile = 'b.step'\n\n[[part]]\n"
        "name = 'left'\nfile = 'deep/er/c.iges'\nspacing = 0.2\ncutter = ['R6L80', 'R8L80']\nflip = true\n"
    )
    one, two = found(file)
    assert (one.name, one.options) == ("b", {"spacing": 0.5})
    assert (two.name, two.file) == ("left", str(folder / "deep/er/c.iges"))
    assert two.options == {"spacing": 0.2, "cutter": ["R6L80", "R8L80"], "flip": True}


def test_a_wrong_line_of_toml_costs_its_part_alone(folder):
    file = folder / "parts.toml"
    file.write_text(
        "[[part]]\nfile = 'b.step'\ntolerence = 0.1\n[[part]]\nfile = 'gone.step'\n"
        "[[part]]\nname = 'x'\n[[part]]\nfile = 'a.STP'\n"
    )
    parts = found(file)
    assert names(parts) == ["a"]
    assert faults(parts) == [
        f"{file}:3: no option of a part is called tolerence; tolerance?",
        f"{file}:4: no such file: {folder / 'gone.step'}",
        f"{file}:6: file: is missing",
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[[part]\n", "is no TOML"),
        ("[options]\nspacing = 1\n", "part: is missing"),
        ("[options]\nspacing = 1\nspacng = 1\n[[part]]\nfile='b.step'\n", "parts.toml:3: no option of a part is called spacng"),
        ("[[part]]\nfile='b.step'\n[other]\nx=1\n", "parts.toml:3: other: "),
        ("", "part: is missing"),
    ],
)
def test_no_manifest_at_all(folder, text, said):
    (folder / "parts.toml").write_text(text)
    (why,) = faults(found(folder / "parts.toml"))
    assert said in why
    assert "\n" not in why


def test_csv(folder):
    file = folder / "parts.csv"
    file.write_text('file,name,spacing,cutter\nb.step,,0.5,R6L80|R8L80\n# a note\n\n"deep/er/c.iges",right,,\n')
    one, two = found(file)
    assert (one.name, one.options) == ("b", {"spacing": "0.5", "cutter": ["R6L80", "R8L80"]})
    assert (two.name, two.options, two.place) == ("right", {}, f"{file}:5")


def test_csv_says_the_line(folder):
    file = folder / "parts.csv"
    file.write_text("file;tolerence\nb.step;0,1\ngone.step\na.STP;;;\na.STP\n")
    parts = found(file)
    assert names(parts) == ["a"]
    assert [why.partition(": ")[0] for why in faults(parts)] == [f"{file}:{line}" for line in (2, 3, 4)]
    file.write_text("name,file,name\nx,b.step,y\n")
    assert f"{file}:1: its first line" in faults(found(file))[0]


def test_lists(folder):
    file = folder / "parts.txt"
    file.write_text("# today\nb.step\n\ngone.step\n")
    parts = found(file)
    assert names(parts) == ["b"]
    assert faults(parts) == [f"{file}:4: no such file: {folder / 'gone.step'}"]


@pytest.mark.parametrize("name", ["../x", "a/../x", "/x", "x/", "a-plan/x", ".hidden", "a\nb", " x", "a\\b"])
def test_names_that_would_write_elsewhere(folder, name):
    file = folder / "parts.toml"
    file.write_text("[[part]]\nfile='b.step'\nname=" + '"' + name.replace("\\", "\\\\").replace("\n", "\\n") + '"\n')
    (why,) = faults(found(file))
    assert "the name" in why


def test_a_manifest_that_is_not_there(folder):
    (why,) = faults(found(folder / "none.toml"))
    assert why.endswith("none.toml: no such file")
    with pytest.raises(PlanError):
        manifest(str(folder), KNOWN)


def test_files_of_a_relative_folder_are_relative(folder, monkeypatch):
    """Reports name them as a repository does: a service that shows findings knows no other folder."""
    monkeypatch.chdir(folder.parent)
    absolute = [each.file for each in found(str(folder))]
    assert [each.file for each in found(folder.name)] == [f"{folder.name}/{each.removeprefix(f'{folder}/')}" for each in absolute]
    assert [each.file for each in found(f"{folder.name}/**/*.step")]
    assert not [each for each in found(f"{folder.name}/**/*.step") if each.file.startswith("/")]
