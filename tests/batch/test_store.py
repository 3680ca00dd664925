"""The output: here, in memory and on object storage, whole or not at all."""

import json
import os

import fsspec
import pytest

from plan_cutters.errors import PlanError
from plan_cutters.files.folder import read
from plan_cutters_batch.row import PartRow
from plan_cutters_batch.store import MARKER, Store

ROW = PartRow(name="a", file="a.step", key="k1", status="planned", code=0, folder="a-plan")
FILES = {"review.html": b"page", "plan.json": b"{}"}


@pytest.fixture(scope="module")
def bucket():
    """A bucket on a server of this machine, with credentials in the environment; its URL."""
    from moto.server import ThreadedMotoServer

    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    words = {"AWS_ACCESS_KEY_ID": "test", "AWS_SECRET_ACCESS_KEY": "test", "AWS_DEFAULT_REGION": "us-east-1",
             "AWS_ENDPOINT_URL_S3": f"http://{host}:{port}", "AWS_EC2_METADATA_DISABLED": "true"}  # fmt: skip
    before = dict(os.environ)
    os.environ.update(words)
    try:
        fs = fsspec.filesystem("s3", skip_instance_cache=True)
        fs.mkdir("shop")
        yield "s3://shop"
    finally:
        os.environ.clear()
        os.environ.update(before)
        server.stop()


@pytest.fixture(params=["local", "memory", "s3"])
def store(request, tmp_path):
    if request.param == "local":
        yield Store(str(tmp_path / "out"))
    elif request.param == "memory":
        yield Store("memory://out")
        fsspec.filesystem("memory").rm("/", recursive=True)
    else:
        yield Store(f"{request.getfixturevalue('bucket')}/{tmp_path.name}")


def names(store):
    fs, root = fsspec.core.url_to_fs(store.root_url, use_listings_cache=False)
    return sorted(path.removeprefix(root).strip("/") for path in fs.find(root))


@pytest.mark.slow("runs a batch", only=("s3",))
def test_a_part_is_done_when_its_marker_says_so(store):
    token = store.begin()
    assert store.seen(token)
    assert not store.seen("another")
    assert store.row("a-plan") is None
    store.publish("a-plan", FILES, ROW)
    assert store.row("a-plan") == ROW
    store.put("index.csv", b"name\n")
    store.end()
    assert names(store) == ["a-plan/done.json", "a-plan/plan.json", "a-plan/review.html", "index.csv"]
    # What is planned anew takes the place of all that was there.
    store.publish("a-plan", {"plan.json": b"{ }"}, ROW.model_copy(update={"key": "k2"}))
    assert store.row("a-plan").key == "k2"
    assert [name for name in names(store) if name.startswith("a-plan")] == ["a-plan/done.json", "a-plan/plan.json"]


@pytest.mark.slow("starts a server", only=("s3",))
def test_a_file_that_was_changed_or_lost_makes_the_part_undone(store):
    store.publish("a-plan", FILES, ROW)
    store.remove("a-plan/review.html")
    assert store.row("a-plan") is None
    store.publish("a-plan", FILES, ROW)
    store.put("a-plan/plan.json", b"{}, and more")
    assert store.row("a-plan") is None
    # Bytes of the same number are others all the same.
    store.publish("a-plan", FILES, ROW)
    store.put("a-plan/review.html", b"PAGE")
    assert store.row("a-plan") is None
    store.put("a-plan/" + MARKER, b"no marker")
    assert store.row("a-plan") is None


@pytest.mark.slow("starts a server", only=("s3",))
def test_a_marker_that_was_edited_is_none(store):
    store.publish("a-plan", FILES, ROW)
    marker = json.loads(store._content("a-plan/" + MARKER))
    for forged in (
        marker | {"row": marker["row"] | {"code": 1}},
        marker | {"sha256": {}},
        marker | {"sha256": {"plan.json": marker["sha256"]["plan.json"]}},
        {name: value for name, value in marker.items() if name != "seal"},
        # As it was written once, with sizes alone.
        {"row": marker["row"], "files": {name: len(data) for name, data in FILES.items()}},
        [],
    ):
        store.put("a-plan/" + MARKER, json.dumps(forged).encode())
        assert store.row("a-plan") is None
    store.put("a-plan/" + MARKER, json.dumps(marker).encode())
    assert store.row("a-plan") == ROW


def test_what_another_user_wrote_is_not_taken(tmp_path):
    store, other = Store(str(tmp_path)), Store(str(tmp_path))
    store.publish("a-plan", FILES, ROW)
    assert (tmp_path / "a-plan" / MARKER).stat().st_mode & 0o022 == 0
    other._user = store._user + 1
    assert (store.row("a-plan"), other.row("a-plan")) == (ROW, None)


@pytest.mark.parametrize("name", ["plan.json", MARKER])
def test_a_pipe_in_the_output_is_not_waited_for(tmp_path, name):
    store = Store(str(tmp_path))
    store.publish("a-plan", FILES, ROW)
    (tmp_path / "a-plan" / name).unlink()
    os.mkfifo(tmp_path / "a-plan" / name)
    assert store.row("a-plan") is None


@pytest.mark.parametrize("at", [1, 2, 3])
def test_a_write_that_fails_half_way_leaves_the_part_undone(store, monkeypatch, at):
    store.publish("a-plan", FILES, ROW)
    count = 0

    def failing(real):
        def write(*words, **more):
            nonlocal count
            count += 1
            if count == at:
                raise OSError(28, "No space left on device")
            return real(*words, **more)

        return write

    if store.local:
        from pathlib import Path

        monkeypatch.setattr(Path, "write_bytes", failing(Path.write_bytes))
    else:
        monkeypatch.setattr(store._fs, "pipe_file", failing(store._fs.pipe_file))
    new = ROW.model_copy(update={"key": "k2"})
    with pytest.raises(PlanError, match="No space left on device"):
        store.publish("a-plan", {name: data + b" new" for name, data in FILES.items()}, new)
    monkeypatch.undo()
    # Here the old ones stay as they were; elsewhere the part is not done.
    assert store.row("a-plan") == (ROW if store.local else None)
    store.publish("a-plan", FILES, new)
    assert store.row("a-plan") == new
    assert names(store) == ["a-plan/done.json", "a-plan/plan.json", "a-plan/review.html"]


def test_what_a_killed_run_left_is_swept(tmp_path):
    store = Store(str(tmp_path))
    (tmp_path / ".batch" / "0123" / "new").mkdir(parents=True)
    store.begin()
    store.end()
    assert list(tmp_path.iterdir()) == []


def test_missing_credentials_and_buckets_are_one_line(bucket, monkeypatch):
    for url in ("s3://no-such-bucket/x", "s3://no-such-bucket"):
        with pytest.raises(PlanError) as error:
            Store(url).begin()
        assert "\n" not in str(error.value)
        assert str(error.value).startswith("s3://no-such-bucket")
    for word in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.delenv(word)
    fsspec.filesystem("s3").clear_instance_cache()
    with pytest.raises(PlanError, match="no credentials"):
        Store("s3://shop/x").begin()
    with pytest.raises(PlanError, match="no credentials"):
        read("s3://shop/x/a.step")


def test_what_no_one_reaches_is_one_line():
    with pytest.raises(PlanError, match=r"^nowhere://x: "):
        Store("nowhere://x")
