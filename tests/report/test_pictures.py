"""The part as a picture: the rasteriser against a slow twin, colours and patterns where they must be, the same bytes twice."""

import numpy as np
import pytest
from PIL import Image

from plan_cutters import plan
from plan_cutters.kernels.linear.raster import draw
from plan_cutters.plan_file.reasons import rgb
from plan_cutters.report.drawing.part import FINER, Body, borders, fitted, frame_towards, view
from tests.support.cad_parts import CAD


def drawn(corner, brightness, owner, height, width):
    depth, seen, shade = (np.full((height, width), -np.inf), np.full((height, width), -1, np.int32), np.zeros((height, width)))
    draw(corner, brightness, owner, depth, seen, shade)
    return depth, seen, shade


def slowly(corner, brightness, owner, height, width):
    """Pixel by pixel: the nearest of all triangles whose corners' shares are all positive."""
    depth, seen, shade = np.full((height, width), -np.inf), np.full((height, width), -1), np.zeros((height, width))
    for i in range(height):
        for j in range(width):
            for t, (a, b, c) in enumerate(corner):
                table = np.array([[a[0], b[0], c[0]], [a[1], b[1], c[1]], [1.0, 1.0, 1.0]])
                if abs(np.linalg.det(table)) < 1e-12:
                    continue
                share = np.linalg.solve(table, [j, i, 1.0])
                near = share @ [a[2], b[2], c[2]]
                if (share >= 0).all() and near > depth[i, j]:
                    depth[i, j], seen[i, j], shade[i, j] = near, owner[t], share @ brightness[t]
    return depth, seen, shade


@pytest.mark.parametrize("seed", range(4))
def test_each_pixel_shows_the_nearest_triangle(seed):
    rng = np.random.default_rng(seed)
    corner = rng.uniform(-8, 32, (14, 3, 3))
    corner[3] = corner[3, :1]  # a point
    corner[4, 2] = 0.5 * (corner[4, 0] + corner[4, 1])  # a line
    brightness, owner = rng.uniform(0, 1, (14, 3)), rng.permutation(14).astype(np.int32)
    one, two = drawn(corner, brightness, owner, 24, 26), slowly(corner, brightness, owner, 24, 26)
    assert np.array_equal(one[1], two[1])
    assert (one[1] >= 0).any()
    assert np.allclose(one[0], two[0])
    assert np.allclose(one[2], two[2])


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -1), (1, -1, 1), (0, -1, 0), (1, 0, 0), (0.2, 0.1, -1)])
@pytest.mark.parametrize("up", [(0, 0, 1), (1, 0, 0)])
def test_views_are_true_and_what_is_up_is_up(direction, up):
    frame = frame_towards(np.array(direction, float), np.array(up, float))
    assert np.allclose(frame @ frame.T, np.eye(3))
    assert np.linalg.det(frame) == pytest.approx(1.0)
    assert np.allclose(frame[2], np.array(direction) / np.linalg.norm(direction))
    assert abs(frame[0] @ np.array(up)) < 1e-9 or np.linalg.norm(np.cross(direction, up)) < 1e-9
    assert frame[1] @ np.array(up) > -1e-9


def test_a_box_fills_its_view_and_its_silhouette_has_its_size():
    import trimesh

    box = trimesh.creation.box((30.0, 10.0, 20.0))
    body = Body(box.triangles, np.repeat(box.face_normals[:, None], 3, axis=1), np.zeros(len(box.triangles), np.int32))
    frame = frame_towards(np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    scale, middle = fitted(frame, box.vertices, 300, 200)
    found = view(frame, body, scale, middle, 300, 200)
    size = (found.seen >= 0).sum() / (scale * FINER) ** 2
    assert size == pytest.approx(30.0 * 20.0, rel=0.01)
    assert not (found.seen[0] >= 0).any()
    assert not (found.seen[:, 0] >= 0).any()
    assert found.depth.max() == pytest.approx(5.0)
    assert borders(found.seen).sum() == pytest.approx(2 * (30 + 20) * scale * FINER, rel=0.02)


def colours(path):
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"), float) / 255


def like(pixels, verdict):
    """Pixels whose hue is that of a verdict, however dark."""
    colour = np.array(rgb(verdict))
    length = np.linalg.norm(pixels, axis=-1)
    along = (pixels @ (colour / np.linalg.norm(colour))) / np.maximum(length, 1e-9)
    return (along > 0.997) & (length > 0.2)


@pytest.mark.slow("plans whole parts")
def test_verdicts_have_their_colours_and_what_is_not_reached_a_pattern_too(tmp_path):
    result = plan("samples/peaks_and_valleys.step", cutters="R10L100", grid=21, area_budget=0)
    assert result.selected is None
    result.write(tmp_path, ["json", "png"])
    first = (tmp_path / "review.png").read_bytes()
    pixels = colours(tmp_path / "review.png")
    assert pixels.shape == (1440, 1800, 3)
    views = pixels[150:1265]
    for verdict in ("interference_free", "accessible", "inaccessible"):
        assert like(views, verdict).sum() > 500, verdict
    assert not like(views, "unjudged").sum() > 50
    # The pattern: of what is not reached a part is far darker than the rest; of what is reached only lines between faces are.
    not_reached, reached = (np.linalg.norm(views[like(views, verdict)], axis=1) for verdict in ("inaccessible", "accessible"))
    assert 0.1 < (not_reached < 0.55 * not_reached.max()).mean() < 0.5
    assert (reached < 0.45 * reached.max()).mean() < 0.05
    result.write(tmp_path, ["json", "png"])
    assert (tmp_path / "review.png").read_bytes() == first
    assert result.plan.part.file


@pytest.mark.slow("plans whole parts")
def test_fixtures_are_drawn_and_let_what_is_behind_them_show(tmp_path):
    options = {"cutters": "R4L50", "grid": 9, "area_budget": 0, "faces": "all"}
    bare = plan("samples/v_groove.step", **options)
    held = plan("samples/v_groove.step", fixtures=["table:-8", "box:10,60,40@28,-30,-5"], **options)
    shares = []
    for name, result in (("bare", bare), ("held", held)):
        result.write(tmp_path / name, ["json", "png"])
        views = colours(tmp_path / name / "review.png")[150:1265]
        shares.append([like(views, verdict).sum() for verdict in ("fixture", "accessible")])
    # Edges of letters and lines are grey as fixtures are.
    assert shares[0][0] < 1000
    assert shares[1][0] > 5000
    assert shares[1][1] > 5000


@pytest.mark.slow("plans whole parts", only=("asitus",))
@pytest.mark.parametrize("path", [CAD / "bladex_upper.iges", CAD / "asitus_ANC101-ill.stp"], ids=lambda path: path.name)
def test_real_files_fill_their_views(path, tmp_path):
    result = plan(path, cutters="R3L60", grid=3, area_budget=0, faces="all")
    written = result.write(tmp_path, ["json", "png"])
    assert "png" in written.files, written.not_written
    pixels = colours(tmp_path / "review.png")
    for rows, columns in ((slice(150, 690), slice(60, 870)), (slice(150, 690), slice(950, 1760)),
                          (slice(730, 1240), slice(60, 870)), (slice(730, 1240), slice(950, 1760))):  # fmt: skip
        part = (pixels[rows, columns].min(axis=-1) < 0.8).mean()
        assert 0.02 < part < 0.98
        assert pixels[rows, columns].std() > 0.05
